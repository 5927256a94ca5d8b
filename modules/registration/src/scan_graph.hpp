// From poses of pairs to poses of all.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape::registration {

/// How `source` lies to `target`, by what the two alone show.
struct GraphEdge {
  std::size_t source = 0;
  std::size_t target = 0;
  Rigid3 target_from_source = Rigid3::Identity();
  double score = 0;  // larger is surer
};

struct ScanGraph {
  /// Scans of one group have poses in one frame, group_from_scan; the frame is that of the group's first
  /// scan.
  std::vector<std::size_t> group;  // of each scan: the index of its group's first scan
  std::vector<Rigid3> group_from_scan;
  /// Of each edge: empty if the poses agree with it, else why it was left aside.
  std::vector<std::string> against;
};

struct GraphScan {
  BoundingBox box;                              // in its own frame
  Rigid3 group_from_scan = Rigid3::Identity();  // for scans that `fixed` binds together
  bool fixed = false;                           // all that are keep their places to each other
};

/// Joins scans into groups along the edges, surest first. An edge is surer by every loop of three edges that
/// it closes; it joins two groups only if the edges between them that agree with it outweigh those that do
/// not, and `conflict` (asked for pairs of scans of either group, where they would then lie:
/// target_from_source) objects to none. `tolerance` is a length: how far an edge may put the other scan's
/// corners from where the poses have them.
[[nodiscard]] ScanGraph join_scans(std::span<const GraphScan> scans, std::span<const GraphEdge> edges,
                                   double tolerance,
                                   const std::function<bool(std::size_t source, std::size_t target,
                                                            const Rigid3& target_from_source)>& conflict);

}  // namespace drape::registration
