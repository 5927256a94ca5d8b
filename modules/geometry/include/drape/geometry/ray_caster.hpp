// Rays against a triangle mesh.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape {

struct RayHit {
  double distance;  // in lengths of the ray's direction
  std::uint32_t face;
  Eigen::Vector3d weights;  // barycentric, of the face's three corners
};

/// A static bounding volume hierarchy over the faces, split by the surface area heuristic in bins (Wald
/// 2007), with the watertight intersection of Woop, Benthin and Wald (2013): no ray slips through between two
/// faces. Both sides of a face are hit. Queries may run on several threads at once.
class RayCaster {
 public:
  /// The mesh is copied as far as it is needed.
  explicit RayCaster(const TriangleMesh& mesh);

  /// The first face along the ray at 0 < distance < max_distance. Of equal distances the lower face number.
  [[nodiscard]] std::optional<RayHit> first_hit(
      const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
      double max_distance = std::numeric_limits<double>::infinity()) const;

  /// Whether anything lies at 0 < distance < max_distance: cheaper than first_hit.
  [[nodiscard]] bool blocked(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_distance = std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    Eigen::Vector3d least;
    Eigen::Vector3d most;
    std::uint32_t first = 0;  // leaf: first triangle; inner node: the second child (the first one follows)
    std::uint32_t count = 0;  // of triangles; 0 for an inner node
  };
  struct Triangle {
    Eigen::Vector3d corners[3];
    std::uint32_t face;
  };
  struct Ray;

  struct Builder;

  /// Visits what the ray may hit, near before far; `any` stops at the first hit.
  [[nodiscard]] std::optional<RayHit> traverse(const Ray& ray, double max_distance, bool any) const;

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
};

}  // namespace drape
