#include "global_placement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <numeric>
#include <optional>

#include "drape/base/parallel.hpp"
#include "pair_search.hpp"
#include "patch_misfit.hpp"
#include "placement.hpp"
#include "scan_graph.hpp"
#include "sliding.hpp"

namespace drape::registration {
namespace {

constexpr std::size_t coarse_points = 2500;
constexpr std::size_t candidates_per_pair = 2;
constexpr std::size_t sequence_window = 2;
constexpr double least_edge_score = 0.01;
constexpr double loop_tolerance_voxels = 4;
// Refined and refuted, a pose bars what would lead there again.
constexpr double refuted_voxels = 6;
// How far off the middle between contradictions a pose may lie that they hold.
constexpr double slack_of_held_voxels = 1;
// Poses from a chain of pairs are a voxel or so off, and edges then hang over: more than in a pair.
constexpr double most_contradiction_in_group = 0.05;
// Refined by all points, the smoothed ones lie a few percent further apart than where they were fitted.
constexpr double slack_of_refined = 1.06;
// A scan that only one other bears out has no loop to prove it: less may contradict. Of what they share, in
// right pairs and in wrong ones that nothing else gives away: patches before refinement up to 0.6 % (0.1 %
// simulated), against 0.6 to 1 %; single returns that should have been stopped, after it, mostly up to 0.9 %,
// against 1.7 %. No right pair has both.
constexpr double doubtful_contradiction_of_smooth = 0.0073;
constexpr double doubtful_seen_through = 0.009;
constexpr double most_contradiction_alone = 2.3;
constexpr double most_contradiction_of_smooth_alone = 0.012;
// Of what they share; none in right pairs, 0.2 to 0.8 % in wrong ones that nothing else gives away.
constexpr double most_void_alone = 0.001;
// Single points beside the outline, of what they share: up to 1.3 % in 777 of 780 right simulated pairs, 2.7
// % and more in five of seven wrong ones.
constexpr double most_missed_alone = 0.025;
// Up to 3.7 in 938 right simulated pairs, 6.4 to 10.3 in wrong ones.
constexpr double most_misfit_alone = 4.7;

std::vector<ScanPair> pairs_to_search(const std::vector<PlacedScan>& placed,
                                      std::span<const ScanSurface> surfaces, const RegisterOptions& options) {
  const std::size_t count = placed.size();
  std::vector<ScanPair> pairs;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j) {
      if (!surfaces[i].is_surface() || !surfaces[j].is_surface()) continue;
      if (placed[i].placed && placed[j].placed) continue;
      const std::size_t steps = std::min(j - i, count - (j - i));  // a round of scans may close
      if (options.sequence && steps > sequence_window) continue;
      pairs.push_back({i, j});
    }
  return pairs;
}

PairHint hint_for(const ScanPair& pair, const RegisterOptions& options) {
  if (options.turntable_step_deg == 0) return {};
  const double steps = static_cast<double>(pair.target) - static_cast<double>(pair.source);
  const Eigen::Vector3d axis(options.turntable_axis[0], options.turntable_axis[1], options.turntable_axis[2]);
  return {Eigen::AngleAxisd(steps * options.turntable_step_deg * std::numbers::pi / 180, axis.normalized())
              .toRotationMatrix()};
}

std::vector<std::optional<SearchedScan>> searched_scans(std::span<const ScanSurface> surfaces, double voxel) {
  std::vector<std::optional<SearchedScan>> searched(surfaces.size());
  parallel_for(surfaces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (surfaces[i].is_surface()) searched[i].emplace(surfaces[i], voxel);
  });
  return searched;
}

// The group that the others' poses are told in: that of the placed scans, else the one with most scans.
std::optional<std::size_t> main_group(const ScanGraph& graph, const std::vector<PlacedScan>& placed,
                                      std::span<const ScanSurface> surfaces) {
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (placed[i].placed) return graph.group[i];
  std::map<std::size_t, std::size_t> sizes;
  for (std::size_t i = 0; i < placed.size(); ++i)
    if (surfaces[i].size() > 0) ++sizes[graph.group[i]];
  if (sizes.empty()) return std::nullopt;
  return std::max_element(sizes.begin(), sizes.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

// How much a pair's sight contradicts a pose that nothing else bears out: before refinement patches, after it
// single returns. Each alone has other causes too.
double contradiction_alone(const PairPose& found, const PairPose& refined) {
  return found.contradiction_of_smooth / doubtful_contradiction_of_smooth +
         refined.seen_through / std::max(refined.overlap, 1e-9) / doubtful_seen_through;
}

bool near_each_other(const Rigid3& a, const Rigid3& b, const CoarseScan& scan, double voxels) {
  double sum = 0;
  for (const Eigen::Vector3d& p : scan.points()) sum += (a * p - b * p).norm();
  return sum < voxels * scan.voxel() * static_cast<double>(scan.size());
}

}  // namespace

GlobalSearch::Joined GlobalSearch::join() const {
  Joined joined;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    for (const PairPose& pose : found_[k])
      if (pose.against.empty()) {
        joined.edges.push_back({pairs_[k].source, pairs_[k].target, pose.target_from_source,
                                std::max(least_edge_score, pose.score())});
        joined.pair_of_edge.push_back(k);
      }
  std::vector<GraphScan> nodes;
  for (std::size_t i = 0; i < placed_.size(); ++i)
    nodes.push_back({surfaces_[i].box(), placed_[i].world_from_scan, placed_[i].placed});
  joined.graph = join_scans(
      nodes, joined.edges, loop_tolerance_voxels * voxel_,
      [&](std::size_t source, std::size_t target, const Rigid3& target_from_source) {
        return searched_[source] && searched_[target] &&
               judge_pair(*searched_[source], *searched_[target], target_from_source).contradiction() >
                   most_contradiction_in_group;
      });
  return joined;
}

// The pairs of scans in different groups that may bring one of them to the main group, by themselves or with
// others.
std::vector<std::size_t> GlobalSearch::apart(const ScanGraph& graph) const {
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (graph.group[pairs_[k].source] != graph.group[pairs_[k].target]) which.push_back(k);
  return which;
}

// What became of each pair: its best pose, and whether the others agree with it.
std::vector<SearchedPair> GlobalSearch::outcome(const Joined& joined) const {
  std::vector<SearchedPair> result;
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    SearchedPair& pair = result.emplace_back();
    pair.first = pairs_[k].source;
    pair.second = pairs_[k].target;
    pair.reason = "nothing in them looks alike";
    if (found_[k].empty()) continue;
    const PairPose& best = found_[k][0];
    pair = {pairs_[k].source,
            pairs_[k].target,
            best.target_from_source,
            best.overlap,
            best.rms_voxels * voxel_,
            best.seen_through,
            best.in_void,
            best.hold,
            best.contradiction_of_smooth,
            false,
            best.against};
  }
  for (std::size_t e = joined.edges.size(); e-- > 0;) {  // a pair's first edge, its best, has the last word
    SearchedPair& pair = result[joined.pair_of_edge[e]];
    pair.accepted = joined.graph.against[e].empty();
    pair.reason = joined.graph.against[e];
    if (pair.accepted) pair.second_from_first = joined.edges[e].target_from_source;
  }
  return result;
}

std::string GlobalSearch::why_unplaced(std::size_t scan, std::size_t group, const ScanGraph& graph,
                                       const std::vector<SearchedPair>& pairs) const {
  if (!surfaces_[scan].is_surface()) return "no pose was given, and its points do not span a surface";
  std::size_t companions = 0;
  for (std::size_t i = 0; i < graph.group.size(); ++i)
    companions += i != scan && graph.group[i] == graph.group[scan] ? 1 : 0;
  const SearchedPair* best = nullptr;
  double most = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const SearchedPair& pair = pairs[k];
    if (found_[k].empty() || (pair.first != scan && pair.second != scan)) continue;
    if (graph.group[pair.first == scan ? pair.second : pair.first] != group) continue;
    if (best != nullptr && !(found_[k][0].score() > most)) continue;
    most = found_[k][0].score();
    best = &pair;
  }
  std::string reason = "no pose was given, and none was found";
  if (companions > 0)
    reason += fmt::format(": it fits {} other scan(s) that do not fit the rest", companions);
  if (best != nullptr)
    reason += fmt::format("; best on {}: {}", label(scans_[best->first == scan ? best->second : best->first]),
                          best->reason);
  return reason;
}

GlobalSearch::GlobalSearch(std::vector<PlacedScan> placed, std::span<const RangeScan> scans,
                           std::span<const ScanSurface> surfaces, const RegisterOptions& options)
    : placed_(std::move(placed)),
      scans_(scans),
      surfaces_(surfaces),
      options_(options),
      voxel_(coarse_voxel(surfaces, coarse_points)),
      searched_(searched_scans(surfaces, voxel_)),
      pairs_(pairs_to_search(placed_, surfaces, options)),
      found_(pairs_.size()),
      searched_thoroughly_(pairs_.size()) {}

void GlobalSearch::search(const std::vector<std::size_t>& which, Effort effort, const Progress& progress) {
  std::size_t done = 0;
  std::mutex reporting;
  parallel_for(which.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const std::size_t k = which[w];
      const ScanPair& pair = pairs_[k];
      found_[k] = search_pair(*searched_[pair.source], *searched_[pair.target], hint_for(pair, options_),
                              effort, candidates_per_pair);
      searched_thoroughly_[k] = effort == Effort::thorough ? 1 : 0;
      const std::lock_guard lock(reporting);
      progress.update(static_cast<double>(++done) / static_cast<double>(which.size()),
                      effort == Effort::quick ? "searching pairs of scans"
                                              : "searching the pairs of scans without a place thoroughly");
    }
  });
}

GlobalPlacement GlobalSearch::place(const Progress& progress) {
  std::vector<std::size_t> all(pairs_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  search(all, Effort::quick, progress.part(0, 0.6));
  Joined joined = join();
  if (const std::vector<std::size_t> left = apart(joined.graph); !left.empty()) {
    search(left, Effort::thorough, progress.part(0.6, 1));
    joined = join();
  }
  return placement(joined);
}

std::optional<GlobalPlacement> GlobalSearch::place_otherwise(const std::vector<RefutedPair>& refuted,
                                                             const Progress& progress) {
  std::vector<std::size_t> again;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (searched_thoroughly_[k] == 0 &&
        std::any_of(refuted.begin(), refuted.end(), [&](const RefutedPair& r) { return of_pair(r, k); }))
      again.push_back(k);
  search(again, Effort::thorough, progress);
  bool other_way = false;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    for (const RefutedPair& r : refuted) {
      if (!of_pair(r, k)) continue;
      const Rigid3 pose = pairs_[k].source == r.scan ? r.other_from_scan : r.other_from_scan.inverse();
      for (PairPose& found : found_[k]) {
        if (found.against.empty() && near_each_other(found.target_from_source, pose,
                                                     searched_[pairs_[k].source]->coarse, refuted_voxels))
          found.against = r.reason;
        other_way |= found.against.empty();
      }
      std::stable_sort(found_[k].begin(), found_[k].end(), [](const PairPose& a, const PairPose& b) {
        return a.against.empty() && !b.against.empty();
      });
    }
  if (!other_way) return std::nullopt;
  return placement(join());
}

GlobalPlacement GlobalSearch::placement(const Joined& joined) const {
  GlobalPlacement result{placed_, outcome(joined), {}};
  const ScanGraph& graph = joined.graph;
  const std::optional<std::size_t> group = main_group(graph, placed_, surfaces_);
  if (!group) return result;
  const bool by_itself =
      std::none_of(placed_.begin(), placed_.end(), [](const PlacedScan& s) { return s.placed; });
  if (by_itself) result.world_scan = group;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    PlacedScan& scan = result.scans[i];
    if (scan.placed || surfaces_[i].size() == 0) continue;
    if (graph.group[i] != *group) {
      scan.reason = why_unplaced(i, *group, graph, result.pairs);
      continue;
    }
    scan.placed = true;
    scan.world_from_scan = graph.group_from_scan[i];
    scan.reason = by_itself && i == *group ? "no pose was given: its own frame is the world"
                                           : "no pose was given: found by fitting pairs of scans";
  }
  return result;
}

bool GlobalSearch::of_pair(const RefutedPair& refuted, std::size_t pair) const {
  const auto& [source, target] = pairs_[pair];
  return (source == refuted.scan && target == refuted.other) ||
         (source == refuted.other && target == refuted.scan);
}

std::string GlobalSearch::against_alone(const RefutedPair& pair, const PairPose& refined) const {
  const SearchedScan& scan = *searched_[pair.scan];
  const SearchedScan& other = *searched_[pair.other];
  if (refined.contradiction_of_smooth > most_contradiction_of_smooth_alone)
    return fmt::format(
        "patches of them, {:.1f} % of what they share, lie in front of what the other saw or where it saw "
        "nothing",
        100 * refined.contradiction_of_smooth);
  PairPose found;
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    if (of_pair(pair, k) && !found_[k].empty()) found = found_[k].front();
  if (contradiction_alone(found, refined) > most_contradiction_alone)
    return fmt::format(
        "{:.1f} % of one lies where the other looked through, and patches of them, {:.1f} % of what they "
        "share, lay in front of what the other saw",
        100 * refined.seen_through, 100 * found.contradiction_of_smooth);
  if (std::max(found.void_of_smooth, refined.void_of_smooth) > most_void_alone)
    return fmt::format("patches of them, {:.1f} % of what they share, lie beside all that the other saw",
                       100 * std::max(found.void_of_smooth, refined.void_of_smooth));
  const double missed =
      other.outline.missed_share(scan.coarse.points(), scan.coarse.normals(), pair.other_from_scan, 1) +
      scan.outline.missed_share(other.coarse.points(), other.coarse.normals(), pair.other_from_scan.inverse(),
                                1);
  if (missed > most_missed_alone * refined.overlap)
    return fmt::format("{:.1f} % of them lie beside all that the other saw, which should have seen them",
                       100 * missed);
  const double misfit =
      patch_misfit(*scan.surface, scan.coarse, *other.surface, other.coarse, pair.other_from_scan);
  if (misfit > most_misfit_alone)
    return fmt::format("patches of them lie {:.1f} times as far apart as their noise explains", misfit);
  return {};
}

PairPose GlobalSearch::judge_refined(std::size_t which, std::size_t other,
                                     const std::vector<PlacedScan>& placed) const {
  const SearchedScan& source = *searched_[which];
  const SearchedScan& target = *searched_[other];
  const Rigid3 refined = placed[other].world_from_scan.inverse() * placed[which].world_from_scan;
  const PairPose pose = judge_pair(source, target, refined, slack_of_refined);
  if (!pose.slides()) return pose;
  const auto slide = slide_to_middle(source, target, refined);
  if (!slide || !near_each_other(slide->target_from_source, refined, source.coarse, slack_of_held_voxels))
    return pose;
  return judge_pair(source, target, refined, slack_of_refined, true);
}

std::optional<Rigid3> GlobalSearch::held_by_sight(std::size_t which,
                                                  const std::vector<PlacedScan>& placed) const {
  std::optional<std::size_t> only;
  if (!searched_[which]) return std::nullopt;
  for (std::size_t other = 0; other < placed.size(); ++other) {
    if (other == which || !placed[other].placed || !searched_[other]) continue;
    const Rigid3 other_from_this = placed[other].world_from_scan.inverse() * placed[which].world_from_scan;
    const PairPose pose = judge_pair(*searched_[which], *searched_[other], other_from_this, slack_of_refined);
    if (pose.against.empty() || (only && pose.slides())) return std::nullopt;
    if (pose.slides()) only = other;
  }
  if (!only) return std::nullopt;
  const auto slide = slide_to_middle(*searched_[which], *searched_[*only],
                                     placed[*only].world_from_scan.inverse() * placed[which].world_from_scan);
  return slide ? std::optional(placed[*only].world_from_scan * slide->target_from_source) : std::nullopt;
}

Objection GlobalSearch::objection(std::size_t which, const std::vector<PlacedScan>& placed) const {
  Objection closest{"it overlaps no other scan", {}};
  double most_overlap = 0;
  std::vector<RefutedPair> bearing_out;
  std::vector<PairPose> poses;
  for (std::size_t other = 0; other < placed.size(); ++other) {
    if (other == which || !placed[other].placed || !searched_[other]) continue;
    const PairPose pose = judge_refined(which, other, placed);
    if (pose.contradiction() > most_contradiction_in_group) return {pose.against, {}};
    if (pose.against.empty()) {
      bearing_out.push_back({which, other, pose.target_from_source, {}});
      poses.push_back(pose);
    }
    if (pose.overlap > most_overlap) {
      most_overlap = pose.overlap;
      closest.reason = pose.against;
    }
  }
  if (bearing_out.empty()) return closest;
  if (bearing_out.size() > 1) return {};
  bearing_out[0].reason = against_alone(bearing_out[0], poses[0]);
  if (bearing_out[0].reason.empty()) return {};
  return {"only one scan bears it out, and " + bearing_out[0].reason, bearing_out[0]};
}

}  // namespace drape::registration
