// Pictures of a mesh by OSMesa (off-screen OpenGL).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/textured_mesh.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::rendering {

/// Which face every pixel's centre sees, and how far away it is along the optical axis.
struct DepthMap {
  static constexpr std::int32_t no_face = -1;
  ImageF depth;               // +infinity where nothing is seen
  Image<std::int32_t> faces;  // no_face where nothing is seen
};

struct ShadedStyle {
  Eigen::Vector3f background = Eigen::Vector3f(1, 1, 1);
  Eigen::Vector3f color = Eigen::Vector3f(0.75F, 0.75F, 0.72F);  // of a mesh without colours
  bool vertex_colors = true;                                     // use them where the mesh has them
  bool highlight_filled = false;                                 // faces marked `filled` in another colour
  int samples_per_side = 2;                                      // supersampling
};

/// Holds one mesh on one off-screen context. Both sides of every face are drawn. Not to be used from two
/// threads at once; several Renderers may work at the same time. Pictures are the camera's width x height, at
/// most 16384 a side (Error{input} beyond). Any unit: near and far planes follow from the mesh.
class Renderer {
 public:
  explicit Renderer(const TriangleMesh& mesh);
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  /// stencil::object where a pixel's centre sees the mesh, else stencil::background.
  [[nodiscard]] Image8 stencil(const Camera& camera);
  [[nodiscard]] DepthMap depth_map(const Camera& camera);
  /// RGB, lit from beside the camera so that shape shows.
  [[nodiscard]] Image8 shaded(const Camera& camera, const ShadedStyle& style = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// RGB picture of a textured model, unlit (or softly lit, to show shape), bilinear filtering.
struct TexturedStyle {
  Eigen::Vector3f background = Eigen::Vector3f(1, 1, 1);
  bool lit = false;
  int samples_per_side = 2;
};
[[nodiscard]] Image8 render_textured(const TexturedMesh& model, const Camera& camera,
                                     const TexturedStyle& style = {});

}  // namespace drape::rendering
