#include "statistical_outliers.hpp"

#include <algorithm>
#include <cmath>

namespace drape::ingest {

std::vector<std::uint8_t> statistical_outliers(const std::vector<double>& mean_distances, double sigmas) {
  std::vector<std::uint8_t> outlier(mean_distances.size(), 0);
  if (mean_distances.size() < 2) return outlier;
  const auto count = static_cast<double>(mean_distances.size());
  double mean = 0;
  for (const double d : mean_distances) mean += d;
  mean /= count;
  double squares = 0;
  for (const double d : mean_distances) squares += (d - mean) * (d - mean);
  // At the straight border of an even sampling the neighbours lie sqrt(2) further, at its corner twice as
  // far, and without noise that is many deviations.
  constexpr double corner = 2.0;
  const double limit = std::max(mean + sigmas * std::sqrt(squares / (count - 1)), corner * mean);
  for (std::size_t i = 0; i < outlier.size(); ++i) outlier[i] = mean_distances[i] > limit ? 1 : 0;
  return outlier;
}

}  // namespace drape::ingest
