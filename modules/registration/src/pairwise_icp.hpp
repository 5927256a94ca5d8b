// One scan onto another from a rough guess, by PCL.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "drape/geometry/rigid3.hpp"

namespace drape::registration {

/// Points with unit normals, in one frame.
struct OrientedPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
};

/// Point-to-plane ICP (Chen and Medioni 1991; PCL's IterativeClosestPointWithNormals) of `source` onto
/// `target` from `guess`, with matches up to each of `reaches` in turn. The result is a local optimum: judge
/// it before it is used.
[[nodiscard]] Rigid3 pairwise_icp(const OrientedPoints& source, const OrientedPoints& target,
                                  const Rigid3& target_from_source_guess, std::span<const double> reaches);

}  // namespace drape::registration
