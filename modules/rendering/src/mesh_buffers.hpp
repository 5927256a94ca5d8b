// Meshes in OpenGL's memory.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "gl_functions.hpp"

namespace drape::rendering {

/// Floats hold coordinates about the middle of the mesh and of about unit size: scans in a national grid keep
/// all their digits.
struct LocalFrame {
  BoundingBox box;  // of the vertices that faces use, in the world; empty without faces
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double scale = 1;  // half the box's diagonal, or 1

  explicit LocalFrame(const TriangleMesh& mesh);
  [[nodiscard]] Eigen::Vector3f from_world(const Eigen::Vector3d& x) const {
    return ((x - center) / scale).cast<float>();
  }
  [[nodiscard]] Eigen::Matrix4d world_from_local() const;
};

namespace attribute {
inline constexpr GLuint position = 0;
inline constexpr GLuint normal = 1;
inline constexpr GLuint color = 2;
inline constexpr GLuint uv = 3;
}  // namespace attribute

using Rgba = Eigen::Matrix<std::uint8_t, 4, 1>;

/// As stored (sRGB-encoded) in 0..1 to bytes; what is outside is clamped.
[[nodiscard]] Rgba to_bytes(const Eigen::Vector3f& color, std::uint8_t alpha);

/// A vertex array of the current context. An attribute that is added again replaces the former one. It lives
/// as long as the context.
class VertexArray {
 public:
  VertexArray();
  void add(GLuint attribute, std::span<const Eigen::Vector3f> values);
  void add(GLuint attribute, std::span<const Eigen::Vector2f> values);
  void add(GLuint attribute, std::span<const Rgba> values);  // arrives as 0..1
  void set_faces(std::span<const Face> faces);
  void bind() const;

 private:
  void fill_buffer(GLenum target, GLuint slot, const void* data, std::size_t bytes);
  GLuint array_ = 0;
  std::array<GLuint, 5> buffers_{};  // one per attribute, and the faces'
};

/// Draws faces [first, first + count) of the bound array's faces.
void draw_faces(std::size_t first, std::size_t count);

}  // namespace drape::rendering
