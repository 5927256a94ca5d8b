// The few figures that sum up many distances.
#pragma once

#include <cstddef>
#include <vector>

namespace drape::metrics {

/// Of values that are not negative, in their own unit. All zero without values.
struct Distribution {
  std::size_t count = 0;
  double mean = 0;
  double rms = 0;
  double median = 0;
  double percentile_95 = 0;  // nearest rank: at least 95 % of the values are not above it
  double max = 0;
};

[[nodiscard]] Distribution distribution(std::vector<double> values);

}  // namespace drape::metrics
