#include "drape/metrics/distribution.hpp"

#include <algorithm>
#include <cmath>

namespace drape::metrics {
namespace {

double nearest_rank(const std::vector<double>& sorted, double fraction) {
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

}  // namespace

Distribution distribution(std::vector<double> values) {
  Distribution result;
  result.count = values.size();
  if (values.empty()) return result;
  // Sorted first: the sums then do not depend on the order that the values came in.
  std::sort(values.begin(), values.end());
  double sum = 0;
  double sum_of_squares = 0;
  for (const double value : values) {
    sum += value;
    sum_of_squares += value * value;
  }
  const auto count = static_cast<double>(values.size());
  result.mean = sum / count;
  result.rms = std::sqrt(sum_of_squares / count);
  result.median = nearest_rank(values, 0.5);
  result.percentile_95 = nearest_rank(values, 0.95);
  result.max = values.back();
  return result;
}

}  // namespace drape::metrics
