#include "drape/registration/register_scans.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>

#include "drape/base/parallel.hpp"
#include "drape/geometry/spatial_order.hpp"
#include "drape/ingest/estimate_normals.hpp"
#include "drape/ingest/point_spacing.hpp"
#include "global_placement.hpp"
#include "joint_refinement.hpp"
#include "merged_cloud.hpp"
#include "pair_quality.hpp"
#include "placement.hpp"
#include "scan_surface.hpp"

namespace drape::registration {
namespace {

using Mask = std::vector<std::uint8_t>;

// Of each scan the normals of its points, its own or else estimated ones, and its surface.
struct PreparedScans {
  explicit PreparedScans(std::span<const RangeScan> scans) : estimated(scans.size()), normals(scans.size()) {
    std::vector<std::optional<ScanSurface>> built(scans.size());
    parallel_for(scans.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const RangeScan& scan = scans[i];
        const double spacing = scan.spacing > 0 ? scan.spacing : ingest::point_spacing(scan);
        const std::vector<std::uint32_t> order = morton_order(scan.cloud.positions);
        normals[i] = scan.cloud.normals;
        if (scan.cloud.normals.size() != scan.cloud.size())
          normals[i] = estimated[i] = ingest::estimate_normals(scan, spacing, order);
        built[i].emplace(scan, spacing, order, normals[i]);
      }
    });
    for (auto& surface : built) surfaces.push_back(std::move(*surface));
  }

  std::vector<std::vector<Eigen::Vector3f>> estimated;
  std::vector<std::span<const Eigen::Vector3f>> normals;
  std::vector<ScanSurface> surfaces;
};

std::vector<Rigid3> poses_of(const std::vector<PlacedScan>& scans) {
  std::vector<Rigid3> poses;
  for (const PlacedScan& scan : scans) poses.push_back(scan.world_from_scan);
  return poses;
}

Mask mask_of(const std::vector<PlacedScan>& scans) {
  Mask mask(scans.size());
  std::transform(scans.begin(), scans.end(), mask.begin(),
                 [](const PlacedScan& s) { return s.placed ? 1 : 0; });
  return mask;
}

double median_spacing(const std::vector<ScanSurface>& surfaces) {
  std::vector<double> spacings;
  for (const ScanSurface& surface : surfaces)
    if (surface.size() > 0) spacings.push_back(surface.scan_spacing());
  if (spacings.empty()) return 0;
  std::sort(spacings.begin(), spacings.end());
  return spacings[spacings.size() / 2];
}

double mean_move(const ScanSurface& surface, const Rigid3& before, const Rigid3& after) {
  constexpr std::size_t enough = 5000;
  const std::vector<std::uint32_t> sample = surface.sample(enough);
  double sum = 0;
  for (const std::uint32_t i : sample)
    sum += (after * surface.points()[i] - before * surface.points()[i]).norm();
  return sample.empty() ? 0.0 : sum / static_cast<double>(sample.size());
}

// Without any pose, and without a search for them, the first scan with points is the world.
std::optional<std::size_t> place_first(std::vector<PlacedScan>& scans,
                                       const std::vector<ScanSurface>& surfaces) {
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (surfaces[i].size() > 0) {
      scans[i].placed = true;
      scans[i].reason = "no pose was given: its own frame is the world";
      return i;
    }
  return std::nullopt;
}

// Joint refinement, taken back if it makes the fit worse. Returns the fits of what stays.
std::vector<FitOnOthers> refine(Registration& result, const std::vector<ScanSurface>& surfaces,
                                double start_reach, double reach, const std::vector<FitOnOthers>& before,
                                std::optional<std::size_t> world_scan, const RegisterOptions& options,
                                const Progress& progress) {
  const Mask use = mask_of(result.scans);
  const JointOptions joint{start_reach, reach, 0.01 * median_spacing(surfaces), options.iterations};
  JointResult refined = refine_jointly(surfaces, poses_of(result.scans), use, joint, progress);
  result.iterations = refined.iterations;
  const auto after = measure_fits(surfaces, refined.world_from_scan, use, reach);
  // The measure differs from what was minimised (weights, and one distance a point): a tenth is no loss.
  if (truncated_mean_square(after, reach) > 1.1 * truncated_mean_square(before, reach)) {
    result.converged = false;
    return before;
  }
  result.converged = refined.converged;
  // Refinement keeps the mean of the poses; where one scan defines the world, the world stays with that scan.
  const Rigid3 world_from_refined =
      world_scan ? result.scans[*world_scan].world_from_scan * refined.world_from_scan[*world_scan].inverse()
                 : Rigid3::Identity();
  for (std::size_t i = 0; i < surfaces.size(); ++i)
    if (use[i] != 0 && i != world_scan)
      result.scans[i].world_from_scan = world_from_refined * refined.world_from_scan[i];
  return after;
}

struct Review {
  bool taken_back = false;           // whether any scan was
  std::vector<RefutedPair> refuted;  // that scans taken back rested on alone
};

// Takes back the scans that were found but, once all are refined, do not fit after all.
Review review_found(Registration& result, const GlobalSearch& search, const GlobalPlacement& found,
                    const Mask& came_with_pose, const std::vector<FitOnOthers>& fits,
                    const RegisterOptions& options) {
  Review review;
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    PlacedScan& scan = result.scans[i];
    if (!scan.placed || came_with_pose[i] != 0 || i == found.world_scan) continue;
    const double percent = 100 * fits[i].any.overlap();
    Objection against = search.objection(i, result.scans);
    if (against.pair) review.refuted.push_back(*against.pair);
    if (against.reason.empty() && percent < options.min_overlap_percent)
      against.reason =
          fmt::format("only {:.0f} % of its points came to lie on other scans (min_overlap_percent: {:g})",
                      percent, options.min_overlap_percent);
    if (against.reason.empty()) {
      scan.reason += fmt::format(" ({:.0f} % overlap)", percent);
    } else {
      scan = {.reason = "no pose was given, and none was found: " + against.reason};
      review.taken_back = true;
    }
  }
  for (SearchedPair& pair : result.searched)
    if (pair.accepted)
      pair.second_from_first =
          result.scans[pair.second].world_from_scan.inverse() * result.scans[pair.first].world_from_scan;
  // No pose rests on the pairs of scans that are not placed.
  for (SearchedPair& pair : result.searched)
    for (const std::size_t end : {pair.first, pair.second})
      if (pair.accepted && !result.scans[end].placed) {
        pair.accepted = false;
        pair.reason = "not placed in the end: " + result.scans[end].reason;
      }
  return review;
}

void report_quality(Registration& result, const std::vector<FitOnOthers>& before,
                    const std::vector<FitOnOthers>& fits) {
  for (std::size_t i = 0; i < fits.size(); ++i) {
    PlacedScan& scan = result.scans[i];
    scan.rms_m = fits[i].any.rms();
    scan.overlap = fits[i].any.overlap();
    if (scan.placed && fits.size() > 1 && fits[i].any.matched == 0)
      scan.reason += "; it overlaps no other scan";
    for (std::size_t j = i + 1; j < fits.size(); ++j) {
      const auto both = [&](const std::vector<FitOnOthers>& all) {
        Fit sum = all[i].each[j];
        sum.matched += all[j].each[i].matched;
        sum.squares += all[j].each[i].squares;
        return sum;
      };
      const double overlap = std::max(fits[i].each[j].overlap(), fits[j].each[i].overlap());
      if (overlap > 0) result.pairs.push_back({i, j, overlap, both(fits).rms(), both(before).rms()});
    }
  }
}

}  // namespace

Registration register_scans(std::span<const RangeScan> scans,
                            std::span<const std::optional<Rigid3>> given_world_from_scan,
                            const RegisterOptions& options, const Progress& progress) {
  assert(scans.size() == given_world_from_scan.size());
  Registration result;
  progress.update(0, "preparing the scans");
  const PreparedScans prepared(scans);
  const std::vector<ScanSurface>& surfaces = prepared.surfaces;
  const double reach = fine_reach(surfaces);
  result.scans = place_given(scans, given_world_from_scan);
  if (options.method == Method::global)
    for (PlacedScan& scan : result.scans) scan = {.reason = scan.reason};
  const Mask came_with_pose = mask_of(result.scans);
  const bool search = options.method == Method::automatic || options.method == Method::global;
  const bool move = options.method != Method::given && reach > 0;
  double start_reach = options.max_distance_spacings * median_spacing(surfaces);
  GlobalPlacement found;
  std::optional<GlobalSearch> global;
  if (!search && std::count(came_with_pose.begin(), came_with_pose.end(), 1) == 0)
    found.world_scan = place_first(result.scans, surfaces);
  if (search && std::count(came_with_pose.begin(), came_with_pose.end(), 0) > 0) {
    global.emplace(result.scans, scans, surfaces, options);
    found = global->place(progress.part(0.1, 0.6));
    start_reach = std::max(start_reach, 2 * global->voxel());
  }
  std::vector<Rigid3> at_start;
  std::vector<FitOnOthers> before;
  std::vector<FitOnOthers> fits;
  const auto settle = [&](const Progress& part) {
    if (global) {
      result.scans = found.scans;
      result.searched = found.pairs;
    }
    at_start = poses_of(result.scans);
    fits = before = measure_fits(surfaces, at_start, mask_of(result.scans), reach);
    if (move) fits = refine(result, surfaces, start_reach, reach, before, found.world_scan, options, part);
    bool moved = false;
    for (std::size_t i = 0; global && move && i < scans.size(); ++i) {
      if (!result.scans[i].placed || came_with_pose[i] != 0 || i == found.world_scan) continue;
      if (const auto pose = global->held_by_sight(i, result.scans)) {
        result.scans[i].world_from_scan = *pose;
        moved = true;
      }
    }
    if (moved) fits = measure_fits(surfaces, poses_of(result.scans), mask_of(result.scans), reach);
    return global ? review_found(result, *global, found, came_with_pose, fits, options) : Review();
  };
  Review review = settle(progress.part(0.6, 0.8));
  if (!review.refuted.empty())
    if (auto otherwise = global->place_otherwise(review.refuted, progress.part(0.8, 0.85))) {
      found = std::move(*otherwise);
      review = settle(progress.part(0.85, 0.9));
    }

  const Mask use = mask_of(result.scans);
  if (review.taken_back) fits = measure_fits(surfaces, poses_of(result.scans), use, reach);
  report_quality(result, before, fits);
  for (std::size_t i = 0; i < scans.size(); ++i)
    result.scans[i].moved_m = mean_move(surfaces[i], at_start[i], result.scans[i].world_from_scan);
  progress.update(0.9, "merging the scans");
  result.merged = merged_cloud(scans, prepared.normals, poses_of(result.scans), use);
  if (options.thin_spacings > 0)
    result.merged = thinned(result.merged, options.thin_spacings * median_spacing(surfaces));
  progress.update(1);
  return result;
}

}  // namespace drape::registration
