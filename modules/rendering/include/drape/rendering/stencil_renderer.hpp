// The same stencils as Renderer's, for whoever needs thousands of them.
#pragma once

#include <memory>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::rendering {

/// Holds one mesh and one picture. Not to be used from two threads at once; give each its own. Of a closed,
/// consistently oriented mesh that is wholly in front of the camera only the sides that face away are drawn:
/// they cover the same pixels, in half the time.
class StencilRenderer {
 public:
  /// Error{input} for a mesh that breaks its promises or a size outside of 1..4096 a side.
  StencilRenderer(const TriangleMesh& mesh, int width, int height);
  ~StencilRenderer();
  StencilRenderer(StencilRenderer&&) noexcept;
  StencilRenderer& operator=(StencilRenderer&&) noexcept;

  /// As Renderer::stencil. `camera` has the size given to the constructor. The picture is good until the next
  /// call.
  [[nodiscard]] const Image8& draw(const Camera& camera);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drape::rendering
