#include "drape/ingest/clean_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "drape/ingest/point_spacing.hpp"
#include "drape/ingest/spatial_order.hpp"
#include "islands.hpp"
#include "kept_points.hpp"
#include "lattice_view.hpp"
#include "mixed_pixels.hpp"
#include "neighborhoods.hpp"
#include "point_filters.hpp"
#include "statistical_outliers.hpp"
#include "support_plane.hpp"
#include "surface_normals.hpp"

namespace drape::ingest {
namespace {

using Flags = std::vector<std::uint8_t>;

// Takes flagged points out of the scan and counts them under the filter's name.
void drop(CleanedScan& cleaned, const std::string& filter, const Flags& flags) {
  cleaned.dropped[filter] = static_cast<std::size_t>(std::count(flags.begin(), flags.end(), std::uint8_t{1}));
  cleaned.scan = without_points(std::move(cleaned.scan), flags);
}

Flags not_finite(const std::vector<Eigen::Vector3d>& points) {
  Flags flags(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) flags[i] = points[i].allFinite() ? 0 : 1;
  return flags;
}

Flags duplicates(const std::vector<Eigen::Vector3d>& points) {
  Flags flags(points.size(), 0);
  const auto order = morton_order(points);  // equal points lie side by side, the first of them first
  for (std::size_t i = 1; i < order.size(); ++i)
    if (points[order[i]] == points[order[i - 1]]) flags[order[i]] = 1;
  return flags;
}

bool has_sound_normals(const PointCloud& cloud) {
  return !cloud.empty() && cloud.normals.size() == cloud.size() &&
         std::all_of(cloud.normals.begin(), cloud.normals.end(),
                     [](const Eigen::Vector3f& n) { return n.allFinite() && n.squaredNorm() > 0; });
}

// New normals, fitted to the kept points alone, where a dropped point took part in the fit.
void refit_beside_dropped(std::vector<Eigen::Vector3f>& normals, const OrderedPoints& before,
                          const Flags& dropped, const std::vector<double>& reaches, std::size_t neighbors,
                          const std::vector<Eigen::Vector3d>& all_points) {
  // A few points reach very far, and looking around every dropped one that far would take for ever: they are
  // fitted anew in any case.
  std::vector<double> sorted = reaches;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  if (!sorted.empty()) std::nth_element(sorted.begin(), middle, sorted.end());
  const double far = sorted.empty() ? 0.0 : 4 * *middle;
  Flags touched(dropped.size(), 0);
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < dropped.size(); ++i) {
    if (dropped[i] == 0) {
      kept.push_back(all_points[i]);
      if (reaches[i] > far) touched[i] = 1;
      continue;
    }
    for (const Neighbor& near : before.tree().within(all_points[i], far)) {
      const std::uint32_t other = before.original(near.index);
      if (std::sqrt(near.squared_distance) <= reaches[other]) touched[other] = 1;
    }
  }
  std::vector<std::size_t> targets;
  std::vector<Eigen::Vector3d> queries;
  for (std::size_t i = 0; i < dropped.size(); ++i)
    if (touched[i] != 0 && dropped[i] == 0) {
      targets.push_back(i);
      queries.push_back(all_points[i]);
    }
  if (targets.empty()) return;
  const auto fitted = normals_at(OrderedPoints(kept), queries, neighbors);
  for (std::size_t i = 0; i < targets.size(); ++i) normals[targets[i]] = fitted[i];
}

// Statistical outliers out, unoriented normals in: for a scan without a grid both from one pass over the
// neighbourhoods.
void drop_outliers_and_fit_normals(CleanedScan& cleaned, const CleanOptions& options, bool own_normals,
                                   double spacing) {
  RangeScan& scan = cleaned.scan;
  const bool fit_here = !own_normals && !scan.grid;
  const std::size_t fit_neighbors = fit_here ? neighbors_in_disc(options.normal_radius_spacings) : 0;
  const std::size_t distance_neighbors =
      options.outlier_sigma > 0 ? static_cast<std::size_t>(options.outlier_neighbors) : 0;

  if (fit_neighbors > 0 || distance_neighbors > 0) {
    const OrderedPoints ordered(scan.cloud.positions);
    Neighborhoods found = measure_neighborhoods(ordered, distance_neighbors, fit_neighbors);
    Flags outlier(scan.cloud.size(), 0);
    if (distance_neighbors > 0) {
      const LocalSpacing local(scan, spacing);
      for (std::size_t i = 0; i < scan.cloud.size(); ++i)
        found.mean_distances[i] /= std::max(local.ratio(scan.cloud.positions[i]), 1e-12);
      outlier = statistical_outliers(found.mean_distances, options.outlier_sigma);
    }
    if (fit_here) {
      refit_beside_dropped(found.normals, ordered, outlier, found.reaches, fit_neighbors,
                           scan.cloud.positions);
      scan.cloud.normals = std::move(found.normals);
    }
    drop(cleaned, "outlier", outlier);
  }
  if (!own_normals && !fit_here)
    scan.cloud.normals = unoriented_normals(scan, spacing, options.normal_radius_spacings);
  for (Eigen::Vector3f& normal : scan.cloud.normals) normal.normalize();
}

// Cosine of the angle between each normal and the direction to the scanner.
std::vector<double> incidence_cosines(const RangeScan& scan, const ScanView& view) {
  std::vector<double> cosines(scan.cloud.size(), 1.0);
  if (view.kind == ScanView::Kind::unknown) return cosines;
  for (std::size_t i = 0; i < cosines.size(); ++i)
    cosines[i] = scan.cloud.normals[i].cast<double>().dot(view.towards_scanner(scan.cloud.positions[i]));
  return cosines;
}

void drop_grazing(CleanedScan& cleaned, const ScanView& view, double max_incidence_deg) {
  const std::vector<double> cosines = incidence_cosines(cleaned.scan, view);
  const double least = std::cos(max_incidence_deg * std::numbers::pi / 180);
  Flags grazing(cosines.size());
  for (std::size_t i = 0; i < cosines.size(); ++i)
    grazing[i] = max_incidence_deg < 90 && cosines[i] < least ? 1 : 0;
  drop(cleaned, "grazing", grazing);
}

std::vector<float> confidences(const RangeScan& scan, const ScanView& view) {
  const std::vector<double> cosines = incidence_cosines(scan, view);
  const auto& stated = scan.cloud.confidences;
  const LocalSpacing local(scan, 1);
  std::vector<float> result(cosines.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = static_cast<float>(std::clamp(cosines[i], 0.0, 1.0) /
                                   std::max(1.0, local.ratio(scan.cloud.positions[i]))) *
                (stated.empty() ? 1.0F : std::clamp(stated[i], 0.0F, 1.0F));
  return result;
}

}  // namespace

CleanedScan clean_scan(const RangeScan& raw, const CleanOptions& options, const Progress& progress) {
  CleanedScan cleaned{raw, {}};
  RangeScan& scan = cleaned.scan;
  progress.update(0, "cleaning " + raw.file);
  drop(cleaned, "not_finite", not_finite(scan.cloud.positions));
  drop(cleaned, "duplicate", duplicates(scan.cloud.positions));
  drop(cleaned, "cropped", outside_of_box(scan, options.crop_box));
  drop(cleaned, "intensity", outside_of_intensities(scan, options.min_intensity, options.max_intensity));
  const double raw_spacing = point_spacing(scan);
  const ScanView view = view_or_lattice_axis(scan);
  if (options.support_plane == SupportPlane::drop)
    drop(cleaned, "support_plane", support_plane(scan, view, options.support_plane_spacings * raw_spacing));

  progress.update(0.2);
  drop(cleaned, "mixed_pixel", mixed_pixels(scan, view, options.mixed_pixel_angle_deg));
  const bool own_normals = options.normals == Normals::automatic && has_sound_normals(scan.cloud);
  drop(cleaned, "sparse",
       sparse_points(scan, raw_spacing, options.outlier_radius_spacings * raw_spacing,
                     static_cast<std::size_t>(options.outlier_radius_points)));
  drop_outliers_and_fit_normals(cleaned, options, own_normals, raw_spacing);

  progress.update(0.7);
  if (!own_normals || view.kind != ScanView::Kind::unknown)
    scan.cloud.normals = oriented_normals(std::move(scan.cloud.normals), scan, view);
  drop_grazing(cleaned, view, options.max_incidence_deg);
  drop(cleaned, "island",
       small_islands(scan, view, raw_spacing, options.island_gap_spacings,
                     static_cast<std::size_t>(options.min_island_points)));
  scan.cloud.confidences = confidences(scan, view);
  drop(cleaned, "thinned", all_but_best_seen(scan.cloud, options.thin_voxel_spacings * raw_spacing));
  scan.spacing = point_spacing(scan);
  progress.update(1);
  return cleaned;
}

}  // namespace drape::ingest
