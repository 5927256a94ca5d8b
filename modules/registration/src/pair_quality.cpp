#include "pair_quality.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"

namespace drape::registration {
namespace {

constexpr std::size_t quality_samples = 3000;

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

double Fit::rms() const {
  return matched > 0 ? std::sqrt(squares / static_cast<double>(matched)) : 0.0;
}

double Fit::scaled_rms() const {
  return matched > 0 ? std::sqrt(scaled_squares / static_cast<double>(matched)) : 0.0;
}

double fine_reach(std::span<const ScanSurface> surfaces) {
  std::vector<double> spacings;
  std::vector<double> noises;
  for (const ScanSurface& surface : surfaces)
    if (surface.is_surface()) {
      spacings.push_back(surface.spacing());
      noises.push_back(surface.noise());
    }
  return std::max(3 * median(spacings), 5 * median(noises));
}

FitOnOthers fit_on_others(std::size_t which, std::span<const ScanSurface> surfaces,
                          std::span<const Rigid3> world_from_scan, std::span<const std::uint8_t> use,
                          double reach) {
  FitOnOthers fit{{}, std::vector<Fit>(surfaces.size())};
  const ScanSurface& surface = surfaces[which];
  if (!surface.is_surface()) return fit;
  const std::vector<std::uint32_t> samples = surface.sample(quality_samples);
  std::vector<Fit> of_sample(samples.size());
  fit.any.samples = samples.size();
  for (std::size_t other = 0; other < surfaces.size(); ++other) {
    if (other == which || use[other] == 0 || !surfaces[other].is_surface()) continue;
    const Rigid3 other_from_this = world_from_scan[other].inverse() * world_from_scan[which];
    fit.each[other].samples = samples.size();
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const auto match =
          surfaces[other].match(other_from_this * surface.points()[samples[k]],
                                other_from_this.linear() * surface.normals()[samples[k]], reach);
      if (!match) continue;
      for (Fit* sum : {&fit.each[other], &of_sample[k]}) {
        ++sum->matched;
        sum->squares += match->distance * match->distance;
        sum->scaled_squares += match->distance * match->distance / (match->scale * match->scale);
      }
    }
  }
  for (const Fit& sample : of_sample)
    if (sample.matched > 0) {
      ++fit.any.matched;
      fit.any.squares += sample.squares / static_cast<double>(sample.matched);
      fit.any.scaled_squares += sample.scaled_squares / static_cast<double>(sample.matched);
    }
  return fit;
}

std::vector<FitOnOthers> measure_fits(std::span<const ScanSurface> surfaces,
                                      std::span<const Rigid3> world_from_scan,
                                      std::span<const std::uint8_t> use, double reach) {
  std::vector<FitOnOthers> fits(surfaces.size());
  parallel_for(surfaces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      fits[i] = use[i] != 0 ? fit_on_others(i, surfaces, world_from_scan, use, reach)
                            : FitOnOthers{{}, std::vector<Fit>(surfaces.size())};
  });
  return fits;
}

double truncated_mean_square(const std::vector<FitOnOthers>& fits, double reach) {
  double sum = 0;
  double samples = 0;
  for (const FitOnOthers& fit : fits) {
    sum += fit.any.scaled_squares + static_cast<double>(fit.any.samples - fit.any.matched) * reach * reach;
    samples += static_cast<double>(fit.any.samples);
  }
  return samples > 0 ? sum / samples : 0.0;
}

}  // namespace drape::registration
