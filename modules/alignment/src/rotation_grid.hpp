// The rotations of the first pass.
#pragma once

#include <cstddef>
#include <vector>

#include "canonical_frame.hpp"

namespace drape::alignment {

/// Pitch, yaw and roll over 0..360 by the step (Algorithm 4), 360 itself left out.
struct RotationGrid {
  std::vector<EulerAngles> cells;
  /// Per cell, the first cell with the same rotation: of the 512 cells of a 45 degree grid, 208 are distinct.
  std::vector<std::size_t> same_rotation;
  /// Per cell, whether an earlier one differs by (pitch + 180, 180 - yaw, roll + 180), which is the same
  /// rotation with the same rotations round it: refining both would do the same work twice.
  std::vector<bool> has_earlier_twin;
};

[[nodiscard]] RotationGrid rotation_grid(double step_deg);

}  // namespace drape::alignment
