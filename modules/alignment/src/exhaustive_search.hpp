// Algorithms 4, 5 and 6 of the thesis.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "canonical_frame.hpp"
#include "drape/alignment/exhaustive_options.hpp"
#include "drape/base/progress.hpp"
#include "fitness.hpp"
#include "image_stencil.hpp"
#include "stencil_renderer_pool.hpp"

namespace drape::alignment {

struct FittedPose {
  ModelPose pose;
  double fitness = 0;
};

struct SearchResult {
  FittedPose best;
  std::vector<FittedPose> candidates;  // refined ones, best first
  bool accepted = false;               // a candidate exceeded accept_overlap_percent
  bool every_candidate_dropped = false;
  int candidates_listed = 0;
  int candidates_tried = 0;
  double pass1_seconds = 0;
  std::int64_t stencils_drawn = 0;
};

struct SearchInput {
  const TriangleMesh& mesh;  // what is drawn
  const CanonicalFrame& frame;
  const ImageStencil& image;
  double fov_deg;
};

[[nodiscard]] SearchResult exhaustive_search(const SearchInput& input, const ExhaustiveOptions& options,
                                             const Progress& progress);

}  // namespace drape::alignment
