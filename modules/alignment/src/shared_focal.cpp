#include "drape/alignment/shared_focal.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace drape::alignment {
namespace {

constexpr double least_sigma = 0.005;  // of the logarithm: no outline tells a focal length better
constexpr double most_deviations = 3;

struct Opinion {
  double log_focal;
  double sigma;
  [[nodiscard]] double weight() const { return 1 / (sigma * sigma); }
};

std::vector<Opinion> opinions_of(std::span<const Alignment> photos) {
  std::vector<Opinion> opinions;
  for (const Alignment& photo : photos) {
    const bool found = photo.verdict == Verdict::accept && photo.sigma && photo.sigma->focal_percent > 0 &&
                       photo.camera.projection == Camera::Projection::perspective;
    if (!found) continue;
    const double side = std::max(photo.camera.width, photo.camera.height);
    const double focal = std::sqrt(photo.camera.K(0, 0) * photo.camera.K(1, 1));
    opinions.push_back({std::log(focal / side), std::max(least_sigma, photo.sigma->focal_percent / 100)});
  }
  return opinions;
}

double weighted_median(std::vector<Opinion> opinions) {
  std::sort(opinions.begin(), opinions.end(),
            [](const Opinion& a, const Opinion& b) { return a.log_focal < b.log_focal; });
  double total = 0;
  for (const Opinion& opinion : opinions) total += opinion.weight();
  double sum = 0;
  for (const Opinion& opinion : opinions) {
    sum += opinion.weight();
    if (sum >= total / 2) return opinion.log_focal;
  }
  return opinions.back().log_focal;
}

}  // namespace

std::optional<double> shared_focal(std::span<const Alignment> photos) {
  std::vector<Opinion> opinions = opinions_of(photos);
  if (opinions.size() < 2) return std::nullopt;
  const double middle = weighted_median(opinions);
  std::erase_if(opinions, [&](const Opinion& opinion) {
    return std::abs(opinion.log_focal - middle) > most_deviations * opinion.sigma;
  });
  double sum = 0;
  double weights = 0;
  for (const Opinion& opinion : opinions) {
    sum += opinion.weight() * opinion.log_focal;
    weights += opinion.weight();
  }
  return std::exp(sum / weights);
}

}  // namespace drape::alignment
