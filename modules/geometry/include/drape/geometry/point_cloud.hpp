// Points with what a scanner says of each.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace drape {

/// Every attribute is either empty or as long as `positions`.
struct PointCloud {
  std::vector<Eigen::Vector3d> positions;  // in the unit of the frame it is in (workspace: metres)
  std::vector<Eigen::Vector3f> normals;    // unit length; outward where it is known what that is
  std::vector<Eigen::Vector3f> colors;     // red, green, blue as stored (sRGB-encoded), 0..1
  std::vector<float> intensities;          // laser return, 0..1
  std::vector<float> confidences;          // 0..1, higher is better

  [[nodiscard]] std::size_t size() const { return positions.size(); }
  [[nodiscard]] bool empty() const { return positions.empty(); }
};

}  // namespace drape
