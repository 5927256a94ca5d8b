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
  given,   // poses as they are given
  refine,  // given poses, then all scans moved together until their surfaces fit
};

struct RegisterOptions {
  Method method = Method::refine;
  double max_distance_spacings = 16;
  int iterations = 40;
  double min_overlap_percent = 20;
  double max_rms_spacings = 1;
  double thin_spacings = 0;
};

inline void describe(Binder& b, RegisterOptions& o) {
  b.choice("method", o.method, {{"given", Method::given}, {"refine", Method::refine}},
           "given takes the poses as they are; refine moves all scans together until their surfaces fit, and "
           "tries to place a scan without a pose by its overlap with the others");
  b.number("max_distance_spacings", o.max_distance_spacings, {1, 1000},
           "refine: surfaces further apart than this at the start are not drawn together");
  b.number("iterations", o.iterations, {1, 1000}, "refine: stop after so many steps");
  b.number(
      "min_overlap_percent", o.min_overlap_percent, {0, 100},
      "refine: a scan without a pose is placed only if this share of its points then lies on other scans");
  b.number(
      "max_rms_spacings", o.max_rms_spacings, {0, 1000},
      "refine: a scan without a pose is placed only if its points lie this close to the other scans, "
      "root mean square; where a scan is noisier than finely sampled, twice its noise stands for a spacing");
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

struct Registration {
  std::vector<PlacedScan> scans;  // in the order of the input
  std::vector<PairQuality> pairs;
  PointCloud merged;  // every placed scan in the world, with normals and confidences; colours and intensities
                      // if all have them
  bool converged = true;  // false: refine ran out of iterations, or made the fit worse and was undone
  int iterations = 0;
};

/// Puts the scans into the world frame. `given_world_from_scan` has one entry a scan; where one is empty,
/// the pose that the scan itself states is taken. Without any pose the first scan with points defines the
/// world.
///
/// `refine` moves all scans together (point-to-plane, Chen and Medioni 1991; all pairs at once, in the
/// manner of Pulli 1999 and Neugebauer 1997), from coarse to fine distances; the mean motion is zero, so
/// that the world stays where the poses put it. A scan without a pose is tried against the placed ones,
/// starting from its neighbours' poses in the list and from identity, and is placed only if overlap,
/// distance and line of sight all agree; else it is `unplaced` and its reason says what failed. A scan that
/// overlaps no other stays where it was given.
///
/// Scans need not have normals (they are estimated) nor a spacing (it is measured); points must be finite.
/// Works in the unit of the scans. A result that the data do not support is no error: see PlacedScan.
[[nodiscard]] Registration register_scans(std::span<const RangeScan> scans,
                                          std::span<const std::optional<Rigid3>> given_world_from_scan,
                                          const RegisterOptions& options, const Progress& progress);

}  // namespace drape::registration
