// Two coarse scans laid on each other.
#pragma once

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

/// Of every stride-th point of `source`.
[[nodiscard]] CoarseFit measure_fit(const CoarseScan& source, const CoarseScan& target,
                                    const Rigid3& target_from_source, std::size_t stride);

/// Moves `source` onto `target`: distances along the mean of both normals (Rusinkiewicz 2019, which draws
/// from further away than those along one of them), Tukey's weights, with a reach that shrinks from two
/// voxels to one. Takes at most so many steps.
[[nodiscard]] Rigid3 fit_coarsely(const CoarseScan& source, const CoarseScan& target,
                                  const Rigid3& target_from_source_guess, std::size_t stride, int steps);

}  // namespace drape::registration
