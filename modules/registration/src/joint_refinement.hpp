// All scans moved together until their surfaces fit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/geometry/rigid3.hpp"
#include "scan_surface.hpp"

namespace drape::registration {

struct JointOptions {
  double start_reach = 0;  // surfaces this far apart draw each other at first
  double end_reach = 0;    // and this far at last
  double tolerance = 0;    // converged when no scan moves by more
  int iterations = 0;
};

struct JointResult {
  std::vector<Rigid3> world_from_scan;
  bool converged = false;
  int iterations = 0;
};

/// Moves the surfaces that `use` does not mask with 0. Each iteration matches samples of every scan on every
/// other one near it, and takes one Gauss-Newton step on the robust sum of squared point-to-plane distances
/// (Chen and Medioni 1991) over all poses at once; the reach shrinks with the motion. What the matches do
/// not determine (the motion of all scans together, or a plane's sliding along another) does not move. The
/// same bytes for any number of threads.
[[nodiscard]] JointResult refine_jointly(std::span<const ScanSurface> surfaces,
                                         std::span<const Rigid3> world_from_scan,
                                         std::span<const std::uint8_t> use, const JointOptions& options,
                                         const Progress& progress);

}  // namespace drape::registration
