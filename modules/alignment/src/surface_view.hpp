// What a pose shows of a mesh's surface: smooth normals and the scan's own brightness, pixel by pixel.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "outline_drawing.hpp"
#include "outline_mesh.hpp"
#include "outline_pose.hpp"

namespace drape::alignment {

/// A mesh with what its look depends on besides the light. `mesh` must outlive it.
struct LitMesh {
  const OutlineMesh* mesh = nullptr;
  std::vector<Eigen::Vector3f> corner_normals;  // three a face, in the mesh's axes
  std::vector<float> brightness;                // of the scan, per vertex, 0..1; empty: it has none
  /// The mesh is open and its faces agree on which side is out: the inner sides are seen through holes of the
  /// scan, where the object may be closed.
  bool one_sided = false;
};

/// Corner normals are the area-weighted means of the faces about the vertex that are turned from the corner's
/// own face by less than the crease angle (40 degrees). `colors`: per vertex of the mesh, or none.
[[nodiscard]] LitMesh lit_mesh(const OutlineMesh& mesh, const std::vector<Eigen::Vector3f>& colors);

/// Of one pixel; the normal is towards the camera, in its axes. The inner side of a face of a one-sided mesh
/// covers what is behind it, but is not seen.
struct SurfacePixel {
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  float brightness = 1;
  float depth = 0;
  bool covered = false;
  bool seen = false;
};

/// Row by row, width x height of the window. By a depth buffer; `pixels` is kept from one view to the next.
class SurfaceDrawing {
 public:
  void draw(const LitMesh& lit, const OutlinePose& pose, const Window& window);
  [[nodiscard]] const std::vector<SurfacePixel>& pixels() const { return pixels_; }

 private:
  void draw_face(const LitMesh& lit, std::size_t face, const Eigen::Matrix3f& rotation, int width,
                 int height);

  std::vector<Eigen::Vector3f> places_;  // x, y in the window, depth
  std::vector<SurfacePixel> pixels_;
};

/// The share of what a pose shows of the mesh that is inner side; none unless the mesh is one-sided.
[[nodiscard]] double inner_side_share(const OutlineMesh& mesh, const OutlinePose& pose, const Window& window);

}  // namespace drape::alignment
