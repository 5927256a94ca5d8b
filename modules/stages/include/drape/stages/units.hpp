// From the input's units and place to the workspace's: metres near the origin.
#pragma once

#include <string>

#include "drape/geometry/bounding_box.hpp"
#include "drape/io/records.hpp"
#include "drape/pipeline/stage.hpp"

namespace drape::stages {

struct UnitGuess {
  std::string name;  // as `input.units` spells it
  double metres_per_unit;
  std::string reason;
};

/// Of what is scanned, most is between 2 cm and 20 m: a diagonal in that range is taken as metres, a larger
/// one as millimetres.
[[nodiscard]] UnitGuess guess_units(const BoundingBox& box);

/// What to take off coordinates (in metres) that fill `box` (in its own units): its centre in whole metres
/// where that lies over 1000 diagonals and 100 m from the origin, such as map coordinates; else zero.
[[nodiscard]] Eigen::Vector3d far_offset(const BoundingBox& box, double metres_per_unit);

/// The workspace frame for an input that fills `box` (in its own units). Unstated units are guessed, with a
/// warning, and make the run `review`. The offset is far_offset.
[[nodiscard]] io::WorkspaceFrame workspace_frame(const BoundingBox& box, pipeline::StageRun& run);

}  // namespace drape::stages
