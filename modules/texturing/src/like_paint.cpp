#include "like_paint.hpp"

#include "drape/base/random.hpp"
#include "light_problem.hpp"

namespace drape::texturing {
namespace {

constexpr int pairs_of_each = 8;
constexpr int most_tries = 48;
constexpr double like = 0.035;         // of the log colours less their mean: a few percent of noise
constexpr double least_certainty = 1;  // of three channels; one alone has no chromaticity

bool is_like(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const Eigen::Array3d sure = certainty(a, b);
  if (sure.sum() < least_certainty) return false;
  const Eigen::Array3d step = (a - b).cast<double>().array();
  const double brightness = (sure * step).sum() / sure.sum();
  return (sure * (step - brightness).square()).sum() < like * like * sure.sum();
}

}  // namespace

std::vector<LightPair> pairs_of_like_paint(const std::vector<LightSample>& samples,
                                           std::span<const std::uint32_t> own) {
  std::vector<LightPair> pairs;
  Rng rng(own.size());
  for (const std::uint32_t a : own) {
    int found = 0;
    for (int i = 0; i < most_tries && found < pairs_of_each; ++i) {
      const std::uint32_t b = own[rng.below(own.size())];
      if (a == b || !is_like(samples[a].log_color, samples[b].log_color)) continue;
      pairs.push_back({a, b});
      ++found;
    }
  }
  return pairs;
}

}  // namespace drape::texturing
