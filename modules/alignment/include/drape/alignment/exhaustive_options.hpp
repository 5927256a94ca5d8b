// Options of the exhaustive method: chapter 4 of the thesis that drape goes back to.
#pragma once

#include <optional>

#include "drape/base/options.hpp"

namespace drape::alignment {

/// How well two stencils fit, 0 to 100.
enum class Fitness {
  area,  // intersection / union (thesis 4.2.4)
  list,  // outlines point by point from a common point on (thesis 6.2.1)
  rays   // outlines along rays from the centre (thesis 6.2.1)
};

/// How the model is first brought to about the size that it has in the photo.
enum class InitialScale {
  distance,  // along the optical axis: the perspective is that of the field of view
  xy         // x and y alone, as all later scales (the thesis's own)
};

struct ExhaustiveOptions {
  double first_pass_step_deg = 45;
  std::optional<double> refine_start_deg;
  double min_step_deg = 1;
  double drop_step_deg = 6;
  double drop_overlap_percent = 70;
  double accept_overlap_percent = 95;
  double max_candidates_percent = 100;
  double translation_threshold_px = 0.1;
  double fov_range_deg = 5;
  Fitness fitness = Fitness::area;
  InitialScale initial_scale = InitialScale::distance;
  bool box_only = false;
  bool scale_memory = false;
  int stencil_px = 256;
  int max_faces = 20000;
};

inline void describe(Binder& b, ExhaustiveOptions& o) {
  b.number("first_pass_step_deg", o.first_pass_step_deg, {5, 180},
           "exhaustive: pitch, yaw and roll are tried over 0..360 by this");
  b.number("refine_start_deg", o.refine_start_deg, {0.01, 180},
           "exhaustive: first step of the refinement; auto: half the first pass's");
  b.number("min_step_deg", o.min_step_deg, {0.01, 180},
           "exhaustive: the step is halved until it is below this (tau 2)");
  b.number("drop_step_deg", o.drop_step_deg, {0, 180},
           "exhaustive: from this step on a candidate may be dropped (tau 3)");
  b.number("drop_overlap_percent", o.drop_overlap_percent, {0, 100},
           "exhaustive: dropped if no rotation of a step is better than this (tau 4)");
  b.number("accept_overlap_percent", o.accept_overlap_percent, {0, 100},
           "exhaustive: no more candidates once the best is better than this (tau 1)");
  b.number("max_candidates_percent", o.max_candidates_percent, {0, 100},
           "exhaustive: how much of the first pass's sorted list may be refined; one at least");
  b.number(
      "translation_threshold_px", o.translation_threshold_px, {0.001, 100},
      "exhaustive: translated until the stencils' centres are closer than this, in pixels of the stencil");
  b.number("fov_range_deg", o.fov_range_deg, {0, 60},
           "exhaustive: at the end the field of view is searched this far up and down, by 1 degree");
  b.choice("fitness", o.fitness, {{"area", Fitness::area}, {"list", Fitness::list}, {"rays", Fitness::rays}},
           "exhaustive: stencils compared by their area, by their outlines' points in order, or along rays");
  b.choice("initial_scale", o.initial_scale, {{"distance", InitialScale::distance}, {"xy", InitialScale::xy}},
           "exhaustive: sized at first by the distance, or in x and y alone as the thesis does");
  b.flag("box_only", o.box_only,
         "exhaustive: compare within the image stencil's bounding box alone, as the thesis does");
  b.flag("scale_memory", o.scale_memory,
         "exhaustive: each scale starts from the one before, as in the thesis; on one thread");
  b.number("stencil_px", o.stencil_px, {16, 1024},
           "exhaustive: longer side of the stencils that are compared");
  b.number("max_faces", o.max_faces, {4, 100000000},
           "exhaustive: a mesh with more faces is simplified for the search");
}

}  // namespace drape::alignment
