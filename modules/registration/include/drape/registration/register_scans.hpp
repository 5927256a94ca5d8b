// All scans of an object into one frame.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape::registration {

enum class Method {
  automatic,  // global where a scan has no pose, else refine
  given,      // poses as they are given
  refine,     // given poses, then all scans moved together until their surfaces fit
  global,     // without regard to given poses
};

struct RegisterOptions {
  Method method = Method::automatic;
  bool sequence = false;
  std::vector<double> turntable_axis = {0, 1, 0};
  double turntable_step_deg = 0;
  double max_distance_spacings = 16;
  int iterations = 40;
  double min_overlap_percent = 10;
  double thin_spacings = 0;
};

inline void describe(Binder& b, RegisterOptions& o) {
  b.choice(
      "method", o.method,
      {{"auto", Method::automatic},
       {"given", Method::given},
       {"refine", Method::refine},
       {"global", Method::global}},
      "given takes the poses as they are; refine moves all scans together until their surfaces fit; global "
      "finds where each scan belongs by the shape of the surfaces, whatever poses are given, then refines; "
      "auto finds the scans without a pose, keeps those with one, and refines");
  b.flag("sequence", o.sequence,
         "the scans were taken in order, each overlapping those before and after it: only scans up to two "
         "apart in the list are compared (a round of scans may close)");
  b.numbers("turntable_axis", o.turntable_axis, 3, {-1, 1},
            "where turntable_step_deg is set: the table's axis in the scanner's frame");
  b.number("turntable_step_deg", o.turntable_step_deg, {-180, 180},
           "how far a turntable turned the object from each scan to the next, right-handed about "
           "turntable_axis; 0: there was none");
  b.number("max_distance_spacings", o.max_distance_spacings, {1, 1000},
           "surfaces further apart than this at the start of the refinement are not drawn together");
  b.number("iterations", o.iterations, {1, 1000}, "the refinement stops after so many steps");
  b.number("min_overlap_percent", o.min_overlap_percent, {0, 100},
           "a scan that came without a pose stays only if this share of its points lies on other scans");
  b.number("thin_spacings", o.thin_spacings, {0, 1000},
           "merge the points of the cloud that fall into one cube of this edge; 0 keeps every point");
}

struct PlacedScan {
  Rigid3 world_from_scan = Rigid3::Identity();
  bool placed = false;
  std::string reason;  // how it got there, or why it is not placed
  double rms_m = 0;    // point-to-plane distance to the other scans, where they overlap; 0 where they do not
  double overlap = 0;  // share of its points that lie on another scan's surface, 0..1
  double moved_m = 0;  // mean distance of its points from where the given pose has them
};

/// Two placed scans that overlap.
struct PairQuality {
  std::size_t first = 0;  // indices of the scans
  std::size_t second = 0;
  double overlap = 0;       // the larger of the two shares of points on the other's surface, 0..1
  double rms_m = 0;         // point-to-plane distance where they overlap
  double rms_before_m = 0;  // the same for the poses before refinement; 0 where they did not overlap then
};

/// Two scans that were laid on each other without a guess.
struct SearchedPair {
  std::size_t first = 0;  // indices of the scans
  std::size_t second = 0;
  Rigid3 second_from_first = Rigid3::Identity();
  double overlap = 0;        // the larger of the two shares of points on the other's surface, 0..1
  double rms_m = 0;          // distance of these to it, of smoothed points
  double seen_through = 0;   // the larger of the two shares of points that lie where the other looked through
  double in_void = 0;        // the same of points that lie where the other saw nothing at all
  double hold = 0;           // 0 where what they share slides on itself, as planes and round bodies do
  double contradiction = 0;  // of the smoothed lines of sight, against what agrees with them
  bool accepted = false;     // whether the final poses rest on it: both scans are placed, and stayed so
  std::string reason;        // why it is not
};

struct Registration {
  std::vector<PlacedScan> scans;  // in the order of the input
  std::vector<PairQuality> pairs;
  std::vector<SearchedPair> searched;
  PointCloud merged;  // every placed scan in the world, with normals and confidences; colours and intensities
                      // if all have them
  bool converged = true;  // false: refine ran out of iterations, or made the fit worse and was undone
  int iterations = 0;
};

/// Puts the scans into the world frame. `given_world_from_scan` has one entry a scan; where one is empty,
/// the pose that the scan itself states is taken. Where none is used, the first of the scans that fit
/// together defines the world.
///
/// Scans are found without a guess by local features (Rusu et al. 2009), motions that many feature matches
/// agree on (Chen et al. 2022), and a fit of the surfaces; what overlaps well, lies close, and hides nothing
/// that another scan saw joins a graph of scans, in which loops must close. What does not fit is `unplaced`,
/// and its reason says what failed.
///
/// Refinement moves all scans together (point-to-plane, Chen and Medioni 1991; all pairs at once, in the
/// manner of Pulli 1999 and Neugebauer 1997), from coarse to fine distances; the mean motion is zero, so
/// that the world stays where given poses put it. A scan with a pose that overlaps no other stays where it
/// was given.
///
/// Scans need not have normals (they are estimated) nor a spacing (it is measured); points must be finite.
/// Works in the unit of the scans. A result that the data do not support is no error: see PlacedScan.
[[nodiscard]] Registration register_scans(std::span<const RangeScan> scans,
                                          std::span<const std::optional<Rigid3>> given_world_from_scan,
                                          const RegisterOptions& options, const Progress& progress);

}  // namespace drape::registration
