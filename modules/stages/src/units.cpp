#include "drape/stages/units.hpp"

#include <fmt/core.h>

#include <cmath>

#include "drape/base/log.hpp"

namespace drape::stages {

UnitGuess guess_units(const BoundingBox& box) {
  const double diagonal = box.isEmpty() ? 0.0 : box.diagonal().norm();
  if (diagonal > 20)
    return {"mm", 0.001, fmt::format("the diagonal of {:.4g} would be far in metres", diagonal)};
  return {"m", 1.0, fmt::format("a diagonal of {:.4g} is plausible in metres", diagonal)};
}

io::WorkspaceFrame workspace_frame(const BoundingBox& box, pipeline::StageRun& run) {
  io::WorkspaceFrame frame;
  if (const auto stated = pipeline::metres_per_unit(run.input().units)) {
    frame.metres_per_input_unit = *stated;
  } else {
    const UnitGuess guess = guess_units(box);
    frame.metres_per_input_unit = guess.metres_per_unit;
    log::warn("input.units is not set; taken as {}: {}", guess.name, guess.reason);
    run.needs_review(fmt::format("the units were guessed as {}; set input.units", guess.name));
  }
  if (box.isEmpty()) return frame;
  const Eigen::Vector3d center_m = box.center() * frame.metres_per_input_unit;
  const double diagonal_m = box.diagonal().norm() * frame.metres_per_input_unit;
  if (center_m.norm() > 100 && center_m.norm() > 1000 * diagonal_m)
    frame.world_offset_m = center_m.array().round().matrix();
  return frame;
}

}  // namespace drape::stages
