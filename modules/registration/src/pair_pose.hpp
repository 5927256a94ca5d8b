// How two scans lie to each other, and what speaks against it.
#pragma once

#include <string>

#include "drape/geometry/rigid3.hpp"
#include "searched_scan.hpp"

namespace drape::registration {

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
  double void_of_smooth = 0;   // of this, what lies where the other saw nothing
  bool held_by_sight = false;  // contradictions on either side hold it where the surface does not, see Slide
  std::string against;         // why it is not to be believed; empty if it is

  /// How much contradicts the lines of sight: missing returns have other causes too, and weigh less.
  [[nodiscard]] double contradiction() const { return seen_through + in_void / 5; }
  /// Whether the scans share enough, but of a surface that slides on itself, or nearly.
  [[nodiscard]] bool slides() const;
  /// How firmly surface and sight hold them.
  [[nodiscard]] double firmness() const;
  /// Larger is surer: see `evidence`.
  [[nodiscard]] double score() const;
};

/// The overlap, less ten times what contradicts it. What nearly slides on itself is easily shared by chance:
/// by its hold it counts less.
[[nodiscard]] double evidence(double overlap, double hold, double contradiction);

/// The larger of the two shares of points that lie in front of what the other saw.
[[nodiscard]] double seen_through_share(const SearchedScan& source, const SearchedScan& target,
                                        const Rigid3& target_from_source);

/// What contradicts the smoothed lines of sight, of each way, against what agrees with them.
struct SmoothContradiction {
  double in_front = 0;
  double in_void = 0;

  [[nodiscard]] double sum() const { return in_front + in_void / 2; }
};
[[nodiscard]] SmoothContradiction contradiction_of_smooth(const SearchedScan& source,
                                                          const SearchedScan& target,
                                                          const Rigid3& target_from_source);

/// The shares and the distance for one motion, and what speaks against it. The distance may be `slack` times
/// as large as is believed of a pose that was fitted to the same smoothed points; a pose that is held by
/// sight needs no surface to hold it.
[[nodiscard]] PairPose judge_pair(const SearchedScan& source, const SearchedScan& target,
                                  const Rigid3& target_from_source, double slack = 1,
                                  bool held_by_sight = false);

}  // namespace drape::registration
