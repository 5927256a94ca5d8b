// One photo aligned, and what came of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cells.hpp"
#include "drape/alignment/align.hpp"
#include "drape/geometry/image.hpp"

namespace drape::lab {

inline constexpr double right_deg = 2;  // of rotation relative to the viewing ray: the pose is right

/// What a trial's photo is made of.
struct Shot {
  Camera truth;
  Image8 stencil;               // as segmentation gives it: with the cell's fault
  std::optional<Image8> photo;  // if the cell has one
  std::optional<double> focal_px_hint;
};

/// Photo number `index` of a model under a cell's conditions. The camera depends on the seed, the index and
/// the lens alone, so that cells are compared on the same views.
[[nodiscard]] Shot take_shot(const Model& model, const Cell& cell, std::uint64_t seed, int index);

struct Trial {
  int index = 0;
  double overlap_percent = 0;  // with the object's true outline
  double rotation_deg = 0;
  double about_ray_deg = 0;  // relative to the viewing ray
  std::optional<double> focal_percent;
  bool right = false;
  alignment::Verdict verdict = alignment::Verdict::reject;
  double confidence = 0;    // margin of the score over the next pose, by which trials of a verdict are ranked
  bool has_axis = false;    // of a body of rotation
  bool axis_named = false;  // by the verdict, to 5 degrees
  double cpu_seconds = 0;
  std::vector<std::string> reasons;
  std::optional<alignment::OutlineFigures> outline;
  double sigma_deg = 0;                      // of rotation, as the alignment tells it
  std::optional<double> best_candidate_deg;  // of the poses listed: the least error about the ray

  /// What the verdict should say of a right pose: of a body of rotation that it is free about the axis.
  [[nodiscard]] bool known_as_right() const {
    return has_axis ? axis_named : verdict == alignment::Verdict::accept;
  }
};

[[nodiscard]] Trial align_shot(const Model& model, const Cell& cell, const Shot& shot,
                               const alignment::AlignOptions& options);

[[nodiscard]] std::string verdict_name(alignment::Verdict verdict);

/// Of the best pose's score over the next one's; 1 if there is no other.
[[nodiscard]] double margin(const alignment::Alignment& found);

}  // namespace drape::lab
