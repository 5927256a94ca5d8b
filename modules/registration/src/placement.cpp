#include "placement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "line_of_sight.hpp"
#include "pair_quality.hpp"
#include "pairwise_icp.hpp"

namespace drape::registration {
namespace {

// In right pairs at most 2 % of the points lie where the other scan looked through (measured on real scans).
constexpr double most_seen_through_share = 0.02;
constexpr std::size_t source_points = 1000;
constexpr std::size_t target_points = 20'000;

std::vector<std::uint8_t> placed_mask(const std::vector<PlacedScan>& placed) {
  std::vector<std::uint8_t> mask(placed.size());
  for (std::size_t i = 0; i < placed.size(); ++i) mask[i] = placed[i].placed ? 1 : 0;
  return mask;
}

OrientedPoints sampled(const ScanSurface& surface, const Rigid3& motion, std::size_t count) {
  OrientedPoints result;
  for (const std::uint32_t i : surface.sample(count)) {
    result.points.push_back(motion * surface.points()[i]);
    result.normals.push_back(motion.linear() * surface.normals()[i]);
  }
  return result;
}

OrientedPoints all_placed(const std::vector<PlacedScan>& placed, std::span<const ScanSurface> surfaces) {
  std::size_t count = 0;
  for (const PlacedScan& scan : placed) count += scan.placed ? 1 : 0;
  OrientedPoints result;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (!placed[i].placed || !surfaces[i].is_surface()) continue;
    const OrientedPoints one = sampled(surfaces[i], placed[i].world_from_scan, target_points / count);
    result.points.insert(result.points.end(), one.points.begin(), one.points.end());
    result.normals.insert(result.normals.end(), one.normals.begin(), one.normals.end());
  }
  return result;
}

// Poses to start from: those of the nearest placed scans before and after it in the list, and identity.
std::vector<Rigid3> starts(const std::vector<PlacedScan>& placed, std::size_t which) {
  std::vector<Rigid3> result;
  for (std::size_t i = which; i-- > 0;)
    if (placed[i].placed) {
      result.push_back(placed[i].world_from_scan);
      break;
    }
  for (std::size_t i = which + 1; i < placed.size(); ++i)
    if (placed[i].placed) {
      result.push_back(placed[i].world_from_scan);
      break;
    }
  if (std::none_of(result.begin(), result.end(),
                   [](const Rigid3& r) { return r.isApprox(Rigid3::Identity()); }))
    result.push_back(Rigid3::Identity());
  return result;
}

// Of the points of the scan and of each placed one, the largest share that lies where the other looked
// through.
double most_seen_through(const Rigid3& pose, std::size_t which, const std::vector<PlacedScan>& placed,
                         std::span<const ScanSurface> surfaces, double tolerance) {
  double share = 0;
  for (std::size_t other = 0; other < placed.size(); ++other) {
    if (!placed[other].placed || !surfaces[other].is_surface()) continue;
    const Rigid3 other_from_this = placed[other].world_from_scan.inverse() * pose;
    share = std::max(
        {share, seen_through_share(surfaces[which], surfaces[other], other_from_this, tolerance),
         seen_through_share(surfaces[other], surfaces[which], other_from_this.inverse(), tolerance)});
  }
  return share;
}

Fit fit_at(const Rigid3& pose, std::size_t which, const std::vector<PlacedScan>& placed,
           std::span<const ScanSurface> surfaces, double reach) {
  std::vector<Rigid3> poses;
  for (const PlacedScan& scan : placed) poses.push_back(scan.world_from_scan);
  poses[which] = pose;
  return fit_on_others(which, surfaces, poses, placed_mask(placed), reach).any;
}

// Empty if the pose may be taken.
std::string objection(const Fit& fit, const Rigid3& pose, std::size_t which,
                      const std::vector<PlacedScan>& placed, std::span<const ScanSurface> surfaces,
                      double reach, const RegisterOptions& options) {
  const double overlap_percent = 100 * fit.overlap();
  if (overlap_percent < options.min_overlap_percent || fit.matched == 0)
    return fmt::format("only {:.0f} % of its points came to lie on placed scans (min_overlap_percent: {:g})",
                       overlap_percent, options.min_overlap_percent);
  // Between noisy scans points lie sqrt(2) deviations off; where a wrong fit puts them, three.
  const ScanSurface& surface = surfaces[which];
  const double spacings = fit.scaled_rms() / std::max(surface.spacing(), 2 * surface.noise());
  if (spacings > options.max_rms_spacings)
    return fmt::format("its points came to lie {:.2f} spacings off the placed scans (max_rms_spacings: {:g})",
                       spacings, options.max_rms_spacings);
  // A pixel's depth is certain to within the reach on either side.
  const double seen_through = most_seen_through(pose, which, placed, surfaces, 2 * reach);
  if (seen_through > most_seen_through_share)
    return fmt::format("{:.0f} % of the points came to lie where another scan looked through",
                       100 * seen_through);
  return {};
}

// The best acceptable result for one scan, or why there is none, written into `scan`.
PlacedScan try_to_place(std::size_t which, const std::vector<PlacedScan>& placed,
                        std::span<const ScanSurface> surfaces, double reach, const RegisterOptions& options) {
  PlacedScan scan = placed[which];
  const OrientedPoints source = sampled(surfaces[which], Rigid3::Identity(), source_points);
  const OrientedPoints target = all_placed(placed, surfaces);
  const double size = surfaces[which].box().diagonal().norm();
  const std::array<double, 3> reaches{0.3 * size, 0.06 * size, reach};
  double best_overlap = -1;
  for (const Rigid3& start : starts(placed, which)) {
    const Rigid3 pose = pairwise_icp(source, target, start, reaches);
    const Fit fit = fit_at(pose, which, placed, surfaces, reach);
    if (fit.overlap() <= best_overlap) continue;
    const std::string against = objection(fit, pose, which, placed, surfaces, reach, options);
    if (!against.empty()) {
      if (!scan.placed) scan.reason = "no pose was given, and none was found: " + against;
      continue;
    }
    best_overlap = fit.overlap();
    scan.placed = true;
    scan.world_from_scan = pose;
    scan.reason = fmt::format("no pose was given: found by fitting it to the placed scans ({:.0f} % overlap)",
                              100 * best_overlap);
  }
  return scan;
}

}  // namespace

std::string label(const RangeScan& scan) {
  return scan.index_in_file == 0 ? scan.file : fmt::format("{} (scan {})", scan.file, scan.index_in_file + 1);
}

GivenPlacement place_given(std::span<const RangeScan> scans,
                           std::span<const std::optional<Rigid3>> given_world_from_scan) {
  std::vector<PlacedScan> placed(scans.size());
  bool any_pose = false;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const auto& pose = given_world_from_scan[i] ? given_world_from_scan[i] : scans[i].world_from_scan;
    if (scans[i].cloud.empty()) {
      placed[i].reason = "it has no points";
    } else if (pose) {
      placed[i].placed = true;
      placed[i].world_from_scan = *pose;
      placed[i].reason = "given pose";
      any_pose = true;
    } else {
      placed[i].reason = "no pose was given";
    }
  }
  const auto first =
      std::find_if(scans.begin(), scans.end(), [](const RangeScan& s) { return !s.cloud.empty(); });
  if (!any_pose && first != scans.end()) {
    const auto world = static_cast<std::size_t>(first - scans.begin());
    placed[world].placed = true;
    placed[world].reason = "no pose was given: its own frame is the world";
    return {placed, world};
  }
  return {placed, std::nullopt};
}

std::vector<PlacedScan> place_by_icp(std::vector<PlacedScan> placed, std::span<const RangeScan> scans,
                                     std::span<const ScanSurface> surfaces, double reach,
                                     const RegisterOptions& options, const Progress& progress) {
  bool found = true;
  while (found) {
    found = false;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      if (placed[i].placed || surfaces[i].size() == 0) continue;
      progress.update(static_cast<double>(i) / static_cast<double>(placed.size()),
                      "placing " + label(scans[i]));
      if (!surfaces[i].is_surface()) {
        placed[i].reason = "no pose was given, and its points do not span a surface";
        continue;
      }
      placed[i] = try_to_place(i, placed, surfaces, reach, options);
      found |= placed[i].placed;
    }
  }
  return placed;
}

}  // namespace drape::registration
