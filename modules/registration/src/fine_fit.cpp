#include "fine_fit.hpp"

#include <algorithm>

#include "motion_step.hpp"

namespace drape::registration {
namespace {

constexpr std::size_t samples = 4000;
constexpr std::size_t least_matches = 20;
constexpr int most_steps = 40;
constexpr double damping = 1e-5;

}  // namespace

Rigid3 fit_finely(const ScanSurface& source, const ScanSurface& target,
                  const Rigid3& target_from_source_guess, double start_reach) {
  Rigid3 motion = target_from_source_guess;
  const double end_reach = std::max(3 * std::max(source.spacing(), target.spacing()),
                                    5 * std::max(source.noise(), target.noise()));
  const double radius = std::max(source.box().diagonal().norm() / 2, end_reach);
  double reach = std::max(start_reach, end_reach);
  const std::vector<std::uint32_t> taken = source.sample(samples);
  for (int step = 0; step < most_steps; ++step) {
    MotionStep sums(motion * source.box().center());
    std::size_t matches = 0;
    for (const std::uint32_t i : taken) {
      const Eigen::Vector3d point = motion * source.points()[i];
      const Eigen::Vector3d own = motion.linear() * source.normals()[i];
      const auto match = target.match(point, own, reach);
      if (!match) continue;
      const Eigen::Vector3d normal = (own + match->normal).normalized();
      const double distance = normal.dot(point - match->point) / match->scale;
      const double u = distance / reach;
      if (!(std::abs(u) < 1)) continue;
      sums.add(point, normal, distance, (1 - u * u) * (1 - u * u) / (match->scale * match->scale));
      ++matches;
    }
    if (matches < least_matches) return motion;
    const auto [after, size] = sums.applied_to(motion, radius, damping);
    motion = after;
    if (reach <= end_reach && size < 0.02 * target.spacing()) break;
    reach = std::max(end_reach, 0.85 * reach);
  }
  return motion;
}

}  // namespace drape::registration
