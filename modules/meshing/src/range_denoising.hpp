// Noise out of depths, edges kept.
#pragma once

#include <vector>

#include "range_sheet.hpp"
#include "sample_neighbors.hpp"

namespace drape::meshing {

struct Denoised {
  std::vector<RangeSample> samples;
  float noise = 0;  // that they had: its deviation across the surface, in spacings
};

/// Each sample moved along its ray onto a plane through it and its neighbours, fitted to their depths by
/// iteratively reweighted least squares (biweight at 3 deviations of the noise; Beaton and Tukey 1974), which
/// also gives its slopes; then averaged over as much of its surface as the noise asks for. The noise is that
/// of the samples against planes through their neighbours. A sample across a depth step, farther than
/// `longest_edge_spacings`, is no neighbour.
[[nodiscard]] Denoised denoised(const std::vector<RangeSample>& samples, const SampleNeighbors& neighbors,
                                const Sight& sight, double longest_edge_spacings);

}  // namespace drape::meshing
