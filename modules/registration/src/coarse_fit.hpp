// Two coarse scans laid on each other.
#pragma once

#include <Eigen/Core>

#include "coarse_scan.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape::registration {

/// How the points of one coarse scan lie on another.
struct CoarseFit {
  double overlap = 0;     // share of the points within a voxel of the other's surface, 0..1
  double rms_voxels = 0;  // distance of these to it
  /// How firmly the surface that they share holds one on the other: the squared distance along the normals
  /// that the motion of unit size moves them which moves them least, against that of motions on the average.
  /// 0 for a plane, a cylinder, a ball and all that slides on itself (Gelfand et al. 2003).
  double hold = 0;
};

/// The motions of one scan on another, by how firmly the surface that they share holds it against each.
struct SharedMotions {
  /// Of unit motions, weakest first, as CoarseFit::hold, which is the first of them. All zero where they
  /// share nothing.
  Eigen::Matrix<double, 6, 1> holds = Eigen::Matrix<double, 6, 1>::Zero();

  /// The rigid motion that moves what they share by about `length`, in the target's frame.
  [[nodiscard]] Rigid3 along(int which, double length) const;

  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 1;
  /// Columns: rotation vector about `center` times `radius`, and translation.
  Eigen::Matrix<double, 6, 6> motions = Eigen::Matrix<double, 6, 6>::Identity();
};
[[nodiscard]] SharedMotions shared_motions(const CoarseScan& source, const CoarseScan& target,
                                           const Rigid3& target_from_source);

/// Of every stride-th point of `source`.
[[nodiscard]] CoarseFit measure_fit(const CoarseScan& source, const CoarseScan& target,
                                    const Rigid3& target_from_source, std::size_t stride);

/// Moves `source` onto `target`: distances along the mean of both normals (Rusinkiewicz 2019, which draws
/// from further away than those along one of them), Tukey's weights, with a reach that shrinks from two
/// voxels to one. Takes at most so many steps.
[[nodiscard]] Rigid3 fit_coarsely(const CoarseScan& source, const CoarseScan& target,
                                  const Rigid3& target_from_source_guess, std::size_t stride, int steps);

}  // namespace drape::registration
