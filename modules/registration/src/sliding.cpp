#include "sliding.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "coarse_fit.hpp"

namespace drape::registration {
namespace {

constexpr std::size_t outline_samples = 4000;
constexpr double weak = 0.025;  // held less, a motion is one to slide along
constexpr double step_voxels = 0.25;
constexpr int most_steps = 20;
constexpr double rise = 0.02;  // of the contradiction, by which an end is told
constexpr int rounds = 2;
constexpr double most_play_voxels = 2;
// In right pairs up to 4 % at the start and 0.2 % in the middle, in wrong ones 18 to 30 %.
constexpr double most_at_start = 0.12;
constexpr double most_in_the_middle = 0.01;

double missed_share(const Outline& viewer, const ScanSurface& scan, const Rigid3& viewer_from_scan) {
  const std::size_t stride = std::max<std::size_t>(1, scan.size() / outline_samples);
  return viewer.missed_share(scan.points(), scan.normals(), viewer_from_scan, stride);
}

// Points by themselves, not in patches as where a pose is judged: ends are thin.
double contradiction_of(const SearchedScan& source, const SearchedScan& target,
                        const Rigid3& target_from_source) {
  const double tolerance = smooth_tolerance(source.coarse, target.coarse);
  const Rigid3 source_from_target = target_from_source.inverse();
  return missed_share(target.outline, *source.surface, target_from_source) +
         missed_share(source.outline, *target.surface, source_from_target) +
         target.smooth_sight.in_front_share(source.coarse, target_from_source, tolerance) +
         source.smooth_sight.in_front_share(target.coarse, source_from_target, tolerance);
}

// The steps between two ends at which a function has risen above its least value between them.
struct Trough {
  double least;
  double begin;
  double end;
};

// Walks outward from 0, and on from where it comes lower.
std::optional<Trough> trough_round_zero(const std::function<double(int)>& value) {
  std::map<int, double> known;
  const auto at = [&](int step) {
    const auto found = known.find(step);
    return found != known.end() ? found->second : known.emplace(step, value(step)).first->second;
  };
  double least = at(0);
  int begin = 0;
  int end = 0;
  while (at(begin) < least + rise || at(end) < least + rise) {
    if (at(begin) < least + rise) --begin;
    if (at(end) < least + rise) ++end;
    if (begin < -most_steps || end > most_steps) return std::nullopt;
    least = std::min({least, at(begin), at(end)});
  }
  // Where it came lower later, ends passed before may lie nearer.
  const int bottom = std::min_element(known.begin(), known.end(), [](const auto& a, const auto& b) {
                       return a.second < b.second;
                     })->first;
  const double limit = least + rise;
  const auto crossing = [&](int direction) {
    int step = bottom;
    while (at(step) < limit) step += direction;
    const double inside = at(step - direction);
    return step - direction * (at(step) - limit) / (at(step) - inside);
  };
  return Trough{least, crossing(-1), crossing(1)};
}

}  // namespace

std::optional<Slide> slide_to_middle(const SearchedScan& source, const SearchedScan& target,
                                     const Rigid3& target_from_source) {
  Slide slide{target_from_source, 0, contradiction_of(source, target, target_from_source)};
  if (slide.contradiction > most_at_start) return std::nullopt;
  const double voxel = source.coarse.voxel();
  for (int round = 0; round < rounds; ++round) {
    const SharedMotions motions = shared_motions(source.coarse, target.coarse, slide.target_from_source);
    slide.play_voxels = 0;
    for (int k = 0; k < 6 && motions.holds[k] < weak; ++k) {
      const auto moved = [&](double steps) {
        return motions.along(k, steps * step_voxels * voxel) * slide.target_from_source;
      };
      const auto trough =
          trough_round_zero([&](int step) { return contradiction_of(source, target, moved(step)); });
      if (!trough) return std::nullopt;
      slide.play_voxels = std::max(slide.play_voxels, (trough->end - trough->begin) / 2 * step_voxels);
      slide.contradiction = trough->least;
      slide.target_from_source = moved((trough->begin + trough->end) / 2);
    }
  }
  if (slide.play_voxels > most_play_voxels || slide.contradiction > most_in_the_middle) return std::nullopt;
  return slide;
}

}  // namespace drape::registration
