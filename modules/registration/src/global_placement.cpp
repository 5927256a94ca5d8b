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
#include "placement.hpp"
#include "scan_graph.hpp"

namespace drape::registration {
namespace {

constexpr std::size_t coarse_points = 2500;
constexpr std::size_t candidates_per_pair = 2;
constexpr std::size_t sequence_window = 2;
constexpr double least_edge_score = 0.01;
constexpr double loop_tolerance_voxels = 4;
// Poses from a chain of pairs are a voxel or so off, and edges then hang over: more than in a pair.
constexpr double most_contradiction_in_group = 0.05;
// Refined by all points, the smoothed ones lie a few percent further apart than where they were fitted.
constexpr double slack_of_refined = 1.06;
// A scan that only one other bears out has no loop to prove it: less may contradict. Right pairs, real and
// simulated, have up to 1.1 %, mirror-like objects laid on their mirror image 2.8 %.
constexpr double most_contradiction_alone = 0.02;  // of the firm overlap
constexpr double most_contradiction_of_smooth_alone = 0.012;
constexpr double doubtful_contradiction_of_smooth = 0.008;

struct Pair {
  std::size_t source;
  std::size_t target;
};

std::vector<Pair> pairs_to_search(const std::vector<PlacedScan>& placed,
                                  std::span<const ScanSurface> surfaces, const RegisterOptions& options) {
  const std::size_t count = placed.size();
  std::vector<Pair> pairs;
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

PairHint hint_for(const Pair& pair, const RegisterOptions& options) {
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

// Found poses by pair, best first; of each the best, whether to be believed or not, comes first.
using FoundPoses = std::vector<std::vector<PairPose>>;

void search_pairs(const std::vector<Pair>& pairs, const std::vector<std::size_t>& which,
                  const std::vector<std::optional<SearchedScan>>& scans, const RegisterOptions& options,
                  Effort effort, FoundPoses& found, const Progress& progress) {
  std::size_t done = 0;
  std::mutex reporting;
  parallel_for(which.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const Pair& pair = pairs[which[w]];
      found[which[w]] = search_pair(*scans[pair.source], *scans[pair.target], hint_for(pair, options), effort,
                                    candidates_per_pair);
      const std::lock_guard lock(reporting);
      progress.update(static_cast<double>(++done) / static_cast<double>(which.size()),
                      effort == Effort::quick ? "searching pairs of scans"
                                              : "searching the pairs of scans without a place thoroughly");
    }
  });
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

// Pairs in the order of their search, their found poses, and the graph that these make.
struct Joined {
  std::vector<GraphEdge> edges;
  std::vector<std::size_t> pair_of_edge;
  ScanGraph graph;
};

Joined join(const std::vector<Pair>& pairs, const FoundPoses& found, const std::vector<PlacedScan>& placed,
            std::span<const ScanSurface> surfaces, const std::vector<std::optional<SearchedScan>>& searched,
            double voxel) {
  Joined joined;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    for (const PairPose& pose : found[k])
      if (pose.against.empty()) {
        joined.edges.push_back({pairs[k].source, pairs[k].target, pose.target_from_source,
                                std::max(least_edge_score, pose.score())});
        joined.pair_of_edge.push_back(k);
      }
  std::vector<GraphScan> nodes;
  for (std::size_t i = 0; i < placed.size(); ++i)
    nodes.push_back({surfaces[i].box(), placed[i].world_from_scan, placed[i].placed});
  joined.graph = join_scans(
      nodes, joined.edges, loop_tolerance_voxels * voxel,
      [&](std::size_t source, std::size_t target, const Rigid3& target_from_source) {
        return searched[source] && searched[target] &&
               judge_pair(*searched[source], *searched[target], target_from_source).contradiction() >
                   most_contradiction_in_group;
      });
  return joined;
}

// The pairs of scans in different groups that may bring one of them to the main group, by themselves or with
// others.
std::vector<std::size_t> apart(const std::vector<Pair>& pairs, const ScanGraph& graph) {
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (graph.group[pairs[k].source] != graph.group[pairs[k].target]) which.push_back(k);
  return which;
}

// What became of each pair: its best pose, and whether the others agree with it.
std::vector<SearchedPair> outcome(const std::vector<Pair>& pairs, const FoundPoses& found,
                                  const Joined& joined, double voxel) {
  std::vector<SearchedPair> result;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    SearchedPair& pair = result.emplace_back();
    pair.first = pairs[k].source;
    pair.second = pairs[k].target;
    pair.reason = "nothing in them looks alike";
    if (found[k].empty()) continue;
    const PairPose& best = found[k][0];
    pair = {pairs[k].source,
            pairs[k].target,
            best.target_from_source,
            best.overlap,
            best.rms_voxels * voxel,
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

std::string why_unplaced(std::size_t scan, std::size_t group, const ScanGraph& graph,
                         const std::vector<SearchedPair>& pairs, const FoundPoses& found,
                         std::span<const RangeScan> scans, const ScanSurface& surface) {
  if (!surface.is_surface()) return "no pose was given, and its points do not span a surface";
  std::size_t companions = 0;
  for (std::size_t i = 0; i < graph.group.size(); ++i)
    companions += i != scan && graph.group[i] == graph.group[scan] ? 1 : 0;
  const SearchedPair* best = nullptr;
  double most = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const SearchedPair& pair = pairs[k];
    if (found[k].empty() || (pair.first != scan && pair.second != scan)) continue;
    if (graph.group[pair.first == scan ? pair.second : pair.first] != group) continue;
    if (best != nullptr && !(found[k][0].score() > most)) continue;
    most = found[k][0].score();
    best = &pair;
  }
  std::string reason = "no pose was given, and none was found";
  if (companions > 0)
    reason += fmt::format(": it fits {} other scan(s) that do not fit the rest", companions);
  if (best != nullptr)
    reason += fmt::format("; best on {}: {}", label(scans[best->first == scan ? best->second : best->first]),
                          best->reason);
  return reason;
}

}  // namespace

GlobalPlacement place_globally(std::vector<PlacedScan> placed, std::span<const RangeScan> scans,
                               std::span<const ScanSurface> surfaces, const RegisterOptions& options,
                               const Progress& progress) {
  GlobalPlacement result{std::move(placed), {}, {}, coarse_voxel(surfaces, coarse_points), {}};
  const std::vector<Pair> pairs = pairs_to_search(result.scans, surfaces, options);
  result.searched = searched_scans(surfaces, result.voxel);
  const auto& searched = result.searched;
  FoundPoses found(pairs.size());
  std::vector<std::size_t> all(pairs.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  search_pairs(pairs, all, searched, options, Effort::quick, found, progress.part(0, 0.6));
  Joined joined = join(pairs, found, result.scans, surfaces, searched, result.voxel);
  if (const std::vector<std::size_t> left = apart(pairs, joined.graph); !left.empty()) {
    search_pairs(pairs, left, searched, options, Effort::thorough, found, progress.part(0.6, 1));
    joined = join(pairs, found, result.scans, surfaces, searched, result.voxel);
  }
  result.pairs = outcome(pairs, found, joined, result.voxel);
  const ScanGraph& graph = joined.graph;

  const std::optional<std::size_t> group = main_group(graph, result.scans, surfaces);
  if (!group) return result;
  const bool by_itself =
      std::none_of(result.scans.begin(), result.scans.end(), [](const PlacedScan& s) { return s.placed; });
  if (by_itself) result.world_scan = group;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    PlacedScan& scan = result.scans[i];
    if (scan.placed || surfaces[i].size() == 0) continue;
    if (graph.group[i] != *group) {
      scan.reason = why_unplaced(i, *group, graph, result.pairs, found, scans, surfaces[i]);
      continue;
    }
    scan.placed = true;
    scan.world_from_scan = graph.group_from_scan[i];
    scan.reason = by_itself && i == *group ? "no pose was given: its own frame is the world"
                                           : "no pose was given: found by fitting pairs of scans";
  }
  return result;
}

std::string objection(std::size_t which, const std::vector<PlacedScan>& placed,
                      const std::vector<std::optional<SearchedScan>>& searched) {
  std::string closest = "it overlaps no other scan";
  double most_overlap = 0;
  std::vector<PairPose> bearing_out;
  for (std::size_t other = 0; other < placed.size(); ++other) {
    if (other == which || !placed[other].placed || !searched[other]) continue;
    const PairPose pose =
        judge_pair(*searched[which], *searched[other],
                   placed[other].world_from_scan.inverse() * placed[which].world_from_scan, slack_of_refined);
    if (pose.contradiction() > most_contradiction_in_group) return pose.against;
    if (pose.against.empty()) bearing_out.push_back(pose);
    if (pose.overlap > most_overlap) {
      most_overlap = pose.overlap;
      closest = pose.against;
    }
  }
  // Single returns that are missing have other causes too: the smoothed views must agree that something is
  // wrong.
  if (bearing_out.size() == 1 && bearing_out[0].relative_contradiction() > most_contradiction_alone &&
      bearing_out[0].contradiction_of_smooth > doubtful_contradiction_of_smooth)
    return fmt::format(
        "only one scan bears it out, and {:.1f} % of one lies where the other looked through, {:.1f} % where "
        "it "
        "saw nothing",
        100 * bearing_out[0].seen_through, 100 * bearing_out[0].in_void);
  if (bearing_out.size() == 1 && bearing_out[0].contradiction_of_smooth > most_contradiction_of_smooth_alone)
    return fmt::format(
        "only one scan bears it out, and patches of them, {:.1f} % of what they share, lie in front of what "
        "the "
        "other saw or where it saw nothing",
        100 * bearing_out[0].contradiction_of_smooth);
  return bearing_out.empty() ? closest : std::string();
}

}  // namespace drape::registration
