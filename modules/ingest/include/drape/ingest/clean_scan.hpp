// From what a scanner wrote to points that can be trusted: bad points out, oriented normals and confidences
// in.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/range_scan.hpp"

namespace drape::ingest {

enum class Normals {
  automatic,  // those of the file where it has them, else estimated
  estimate,   // always estimated
};

enum class SupportPlane { keep, drop };

struct CleanOptions {
  std::vector<double> crop_box;
  SupportPlane support_plane = SupportPlane::keep;
  double support_plane_spacings = 3;
  double min_intensity = 0;
  double max_intensity = 1;
  double mixed_pixel_angle_deg = 80;
  double outlier_sigma = 3;
  int outlier_neighbors = 16;
  double outlier_radius_spacings = 0;
  int outlier_radius_points = 4;
  Normals normals = Normals::automatic;
  double normal_radius_spacings = 2.5;
  double max_incidence_deg = 85;
  int min_island_points = 30;
  double island_gap_spacings = 4;
  double thin_voxel_spacings = 0;
};

inline void describe(Binder& b, CleanOptions& o) {
  b.numbers(
      "crop_box", o.crop_box, 6, {-1e12, 1e12},
      "keep only what lies in this box, in the units and the frame of each scan file: least x, y, z, then "
      "greatest x, y, z; without it all is kept");
  b.choice("support_plane", o.support_plane, {{"keep", SupportPlane::keep}, {"drop", SupportPlane::drop}},
           "drop takes out the table or floor that the object stands on, and what lies behind it: a plane "
           "that holds "
           "a sixth of a scan's points at least, with nearly all others on the scanner's side");
  b.number("support_plane_spacings", o.support_plane_spacings, {0.1, 1000},
           "points this close to the support plane belong to it");
  b.number("min_intensity", o.min_intensity, {0, 1},
           "drop points with a weaker return than this, where the scan says so: dark surfaces and dust");
  b.number("max_intensity", o.max_intensity, {0, 1},
           "drop points with a stronger return than this, where the scan says so: glare");
  b.number("mixed_pixel_angle_deg", o.mixed_pixel_angle_deg, {0, 90},
           "at a depth edge of a scan with a grid, drop a point that hangs between front and back: one whose "
           "steps to both of its opposite neighbours lie steeper than this against the view; 90 keeps all");
  b.number("outlier_sigma", o.outlier_sigma, {0, 100},
           "drop points whose mean distance to their neighbours is more than this many standard deviations "
           "above the scan's mean, and more than twice that mean; 0 keeps all");
  b.number("outlier_neighbors", o.outlier_neighbors, {1, 200}, "neighbours that outlier_sigma looks at");
  b.number("outlier_radius_spacings", o.outlier_radius_spacings, {0, 1000},
           "drop points with fewer than outlier_radius_points others within this distance; 0 keeps all");
  b.number("outlier_radius_points", o.outlier_radius_points, {1, 200},
           "how many others a point must have there");
  b.choice("normals", o.normals, {{"auto", Normals::automatic}, {"estimate", Normals::estimate}},
           "auto takes the normals of the file where it has them; estimate computes them always");
  b.number("normal_radius_spacings", o.normal_radius_spacings, {1, 20},
           "radius of the neighbourhood that a normal is estimated from: larger is smoother");
  b.number("max_incidence_deg", o.max_incidence_deg, {0, 90},
           "drop points where the surface meets the laser at more than this angle off the normal (grazing "
           "returns); 90 keeps all");
  b.number("min_island_points", o.min_island_points, {0, 1e6},
           "drop groups of fewer points that lie apart from the rest; the largest group always stays");
  b.number("island_gap_spacings", o.island_gap_spacings, {1, 100},
           "points closer than this belong to one group (those further than 3.5 times this do not)");
  b.number("thin_voxel_spacings", o.thin_voxel_spacings, {0, 1000},
           "of the points in each cube of this edge keep the one that was seen best; 0 keeps all");
}

struct CleanedScan {
  RangeScan scan;  // with normals, confidences and spacing
  /// Points that each filter dropped: not_finite, duplicate, cropped, intensity, support_plane, mixed_pixel,
  /// outlier, sparse, grazing, island, thinned.
  std::map<std::string, std::size_t> dropped;
};

/// Filters a scan, in this order:
/// - points that are not finite, and all but the first of points at the same place;
/// - what lies outside of the crop box, or returned too little or too much;
/// - the plane that the object stands on, if asked for: needs a view;
/// - mixed pixels, where the laser spot lay half on a front and half on a back surface (after Tuley et al.
///   2005): needs a grid;
/// - statistical outliers (Rusu et al. 2008; the rule of PCL's StatisticalOutlierRemoval, but nothing within
///   twice the mean distance goes: there the border of a clean, even scan lies). Where rays diverge from an
///   origin, distances are first divided by the range, so that far surfaces may be sparse;
/// - points with too few others around;
/// - grazing returns: need a view;
/// - small islands;
/// - all but the most confident point of each voxel, if asked for.
///
/// Kept points stay in order, with their attributes, and the grid still points to them. Normals are as in
/// estimate_normals, or the file's own, turned towards the scanner. Confidence is the cosine of the
/// incidence angle (1 where the view is unknown), less in proportion beyond the median range where rays
/// diverge, times the confidence that the raw scan stated. `spacing` is measured on what stays. A scan
/// without points comes back without points.
[[nodiscard]] CleanedScan clean_scan(const RangeScan& raw, const CleanOptions& options,
                                     const Progress& progress);

}  // namespace drape::ingest
