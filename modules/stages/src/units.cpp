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

Eigen::Vector3d far_offset(const BoundingBox& box, double metres_per_unit) {
  if (box.isEmpty()) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d center_m = box.center() * metres_per_unit;
  const bool far = center_m.norm() > 100 && center_m.norm() > 1000 * box.diagonal().norm() * metres_per_unit;
  return far ? Eigen::Vector3d(center_m.array().round()) : Eigen::Vector3d(Eigen::Vector3d::Zero());
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
  frame.world_offset_m = far_offset(box, frame.metres_per_input_unit);
  return frame;
}

}  // namespace drape::stages
