#include "drape/geometry/bounding_box.hpp"

namespace drape {

BoundingBox bounding_box(std::span<const Eigen::Vector3d> points) {
  BoundingBox box;
  for (const Eigen::Vector3d& point : points)
    if (point.allFinite()) box.extend(point);
  return box;
}

}  // namespace drape
