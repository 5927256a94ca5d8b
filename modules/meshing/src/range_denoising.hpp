// Noise out of depths, edges kept.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "range_sheet.hpp"

namespace drape::meshing {

/// The neighbours of each sample: sample i's are indices[first[i]] .. indices[first[i + 1] - 1].
struct SampleNeighbors {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> indices;

  [[nodiscard]] std::span<const std::uint32_t> of(std::size_t sample) const {
    return {indices.data() + first[sample], first[sample + 1] - first[sample]};
  }
};

/// Each sample moved along its ray onto a plane through it and its neighbours, fitted to their depths by
/// iteratively reweighted least squares (biweight at 3 deviations of the noise; Beaton and Tukey 1974), which
/// also gives its slopes. The noise is that of the samples against planes through their neighbours. A sample
/// across a depth step, farther than `longest_edge_spacings`, is no neighbour.
[[nodiscard]] std::vector<RangeSample> denoised(const std::vector<RangeSample>& samples,
                                                const SampleNeighbors& neighbors, const Sight& sight,
                                                double longest_edge_spacings);

}  // namespace drape::meshing
