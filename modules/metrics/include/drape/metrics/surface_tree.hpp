// The closest point of a surface.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::metrics {

/// The triangles of a mesh in a box hierarchy (CGAL's AABB tree). Faces without area are left out. The mesh
/// is copied. Queries may run on several threads at once.
class SurfaceTree {
 public:
  /// Error{input} if the mesh breaks its promises (see problem_of) or has no face with an area.
  explicit SurfaceTree(const TriangleMesh& mesh);
  ~SurfaceTree();
  SurfaceTree(SurfaceTree&&) noexcept;
  SurfaceTree& operator=(SurfaceTree&&) noexcept;

  struct Closest {
    Eigen::Vector3d point;  // on the surface
    double distance;        // in the mesh's unit
    std::uint32_t face;     // that the point lies on; one of them where faces meet
  };
  /// The query is finite.
  [[nodiscard]] Closest closest(const Eigen::Vector3d& query) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace drape::metrics
