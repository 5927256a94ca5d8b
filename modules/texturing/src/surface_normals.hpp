// Normals that vary smoothly over a surface and break at its creases.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::texturing {

/// A point within a face of a mesh, as weights of its three corners.
using Barycentric = Eigen::Vector3d;

class SurfaceNormals {
 public:
  explicit SurfaceNormals(const TriangleMesh& mesh);

  /// Unit length; zero on a face without area.
  [[nodiscard]] Eigen::Vector3d at(std::uint32_t face, const Eigen::Vector3d& point) const;
  /// Linear in the point over a face, and along `at`; its length is no promise.
  [[nodiscard]] Eigen::Vector3d unscaled_at(std::uint32_t face, const Eigen::Vector3d& point) const;
  /// The face's own, unit length; zero without area.
  [[nodiscard]] const Eigen::Vector3d& of_face(std::uint32_t face) const { return face_normals_[face]; }

 private:
  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3d> face_normals_;
  std::vector<std::array<Eigen::Vector3d, 3>> corner_normals_;
};

}  // namespace drape::texturing
