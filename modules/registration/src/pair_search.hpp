// How two scans lie to each other, without a guess.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coarse_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "point_features.hpp"
#include "scan_surface.hpp"
#include "sight_map.hpp"
#include "smooth_sight.hpp"

namespace drape::registration {

/// A scan with all that the search for its place looks at; refers to the surface.
struct SearchedScan {
  SearchedScan(const ScanSurface& of, double voxel)
      : surface(&of),
        coarse(of, voxel),
        features(point_features(coarse)),
        sight(of),
        smooth_sight(of, coarse) {}

  const ScanSurface* surface;
  CoarseScan coarse;
  Features features;
  SightMap sight;
  SmoothSight smooth_sight;
};

/// One way that two scans may lie to each other.
struct PairPose {
  Rigid3 target_from_source = Rigid3::Identity();
  double overlap = 0;       // the larger of the two shares of points on the other's surface, 0..1
  double rms_voxels = 0;    // distance of these to it
  double seen_through = 0;  // the larger of the two shares of points that lie where the other looked through
  double in_void = 0;  // the larger of the two shares of points that lie where the other saw nothing at all
  double hold = 0;     // how firmly the shared surface holds each on the other, see CoarseFit
  /// What contradicts the smoothed lines of sight, each way, against what agrees with them.
  double contradiction_of_smooth = 0;
  double void_of_smooth = 0;  // of this, what lies where the other saw nothing
  std::string against;        // why it is not to be believed; empty if it is

  /// How much contradicts the lines of sight: missing returns have other causes too, and weigh less.
  [[nodiscard]] double contradiction() const { return seen_through + in_void / 5; }
  /// Larger is surer: the overlap, less where it nearly slides on itself, and less ten times the
  /// contradiction.
  [[nodiscard]] double score() const;
};

/// How hard to look.
enum class Effort {
  quick,     // at what local features agree on
  thorough,  // also at what pairs of points all over the scans vote for: noisy scans, and those that share
             // little, need it
};

/// What is known of a pair before it is searched.
struct PairHint {
  std::optional<Eigen::Matrix3d> rotation;  // of target_from_source, to within some degrees
};

/// The shares and the distance for one motion, and what speaks against it. The distance may be `slack` times
/// as large as is believed of a pose that was fitted to the same smoothed points.
[[nodiscard]] PairPose judge_pair(const SearchedScan& source, const SearchedScan& target,
                                  const Rigid3& target_from_source, double slack = 1);

/// The ways that two scans may lie to each other, best first, at most `most`; what nothing speaks against
/// comes before the rest. Motions that feature matches agree on, that of scans taken from the same place, and
/// those that pairs of points vote for, are tried by a few steps of a fit; the best of these are fitted in
/// full, and of them the overlap, the distance and the lines of sight are judged.
[[nodiscard]] std::vector<PairPose> search_pair(const SearchedScan& source, const SearchedScan& target,
                                                const PairHint& hint, Effort effort, std::size_t most);

}  // namespace drape::registration
