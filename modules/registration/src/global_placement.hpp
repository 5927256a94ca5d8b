// Poses for scans that have none.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/registration/register_scans.hpp"
#include "pair_search.hpp"
#include "scan_graph.hpp"
#include "scan_surface.hpp"

namespace drape::registration {

struct GlobalPlacement {
  std::vector<PlacedScan> scans;
  std::vector<SearchedPair> pairs;
  std::optional<std::size_t> world_scan;  // whose frame is the world, where no scan was placed before
};

/// A pose that only one other scan bears out, and what speaks against it.
struct RefutedPair {
  std::size_t scan;
  std::size_t other;
  Rigid3 other_from_scan;
  std::string reason;
};

/// What speaks against the place of a scan; no reason if nothing does.
struct Objection {
  std::string reason;
  std::optional<RefutedPair> pair;  // that the place rests on alone
};

struct ScanPair {
  std::size_t source;
  std::size_t target;
};

/// The search for the places of scans that have none. Refers to the scans and surfaces.
class GlobalSearch {
 public:
  GlobalSearch(std::vector<PlacedScan> placed, std::span<const RangeScan> scans,
               std::span<const ScanSurface> surfaces, const RegisterOptions& options);

  /// Searches every pair of scans in which one is not placed (of those that RegisterOptions' hints leave),
  /// and joins what agrees: to the placed scans where there are any, else the largest group about its first
  /// scan's frame. The rest stays unplaced, with the reason.
  [[nodiscard]] GlobalPlacement place(const Progress& progress);

  /// After `place`: the same without poses that turned out wrong, their pairs searched thoroughly where they
  /// were not yet. Nothing where that leaves no way to lay any of these pairs.
  [[nodiscard]] std::optional<GlobalPlacement> place_otherwise(const std::vector<RefutedPair>& refuted,
                                                               const Progress& progress);

  /// What speaks against the place of one scan among the others: that none bears it out, or only one and not
  /// without doubt, or that one contradicts it.
  [[nodiscard]] Objection objection(std::size_t which, const std::vector<PlacedScan>& placed) const;

  /// Where a scan that only one other bears out, and that by sight alone, lies between what contradicts it:
  /// nothing else keeps refinement from moving it along what they share. Nothing for other scans.
  [[nodiscard]] std::optional<Rigid3> held_by_sight(std::size_t which,
                                                    const std::vector<PlacedScan>& placed) const;

  /// Poses are right to a fraction of it.
  [[nodiscard]] double voxel() const { return voxel_; }

 private:
  // Found poses in the order of their search, as edges, and the graph that these make.
  struct Joined {
    std::vector<GraphEdge> edges;
    std::vector<std::size_t> pair_of_edge;
    ScanGraph graph;
  };

  void search(const std::vector<std::size_t>& which, Effort effort, const Progress& progress);
  [[nodiscard]] Joined join() const;
  [[nodiscard]] std::vector<std::size_t> apart(const ScanGraph& graph) const;
  [[nodiscard]] std::vector<SearchedPair> outcome(const Joined& joined) const;
  [[nodiscard]] std::string why_unplaced(std::size_t scan, std::size_t group, const ScanGraph& graph,
                                         const std::vector<SearchedPair>& pairs) const;
  [[nodiscard]] GlobalPlacement placement(const Joined& joined) const;
  [[nodiscard]] PairPose judge_refined(std::size_t which, std::size_t other,
                                       const std::vector<PlacedScan>& placed) const;
  [[nodiscard]] std::string against_alone(const RefutedPair& pair, const PairPose& refined) const;
  [[nodiscard]] bool of_pair(const RefutedPair& refuted, std::size_t pair) const;

  std::vector<PlacedScan> placed_;  // as they came
  std::span<const RangeScan> scans_;
  std::span<const ScanSurface> surfaces_;
  RegisterOptions options_;
  double voxel_;
  std::vector<std::optional<SearchedScan>> searched_;  // of each scan that spans a surface
  std::vector<ScanPair> pairs_;
  // Found poses by pair, best first; of each the best, whether to be believed or not, comes first.
  std::vector<std::vector<PairPose>> found_;
  std::vector<std::uint8_t> searched_thoroughly_;  // by pair
};

}  // namespace drape::registration
