#include "drape/ingest/clean_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "drape/base/parallel.hpp"
#include "drape/geometry/spatial_order.hpp"
#include "drape/ingest/point_spacing.hpp"
#include "islands.hpp"
#include "kept_points.hpp"
#include "lattice_distances.hpp"
#include "lattice_view.hpp"
#include "mixed_pixels.hpp"
#include "neighborhoods.hpp"
#include "point_filters.hpp"
#include "spacing_parts.hpp"
#include "statistical_outliers.hpp"
#include "support_plane.hpp"
#include "surface_normals.hpp"

namespace drape::ingest {
namespace {

using Flags = std::vector<std::uint8_t>;

struct Filter {
  std::string name;
  Flags flags;
};

// The scan under way, and its points along a space-filling curve.
struct Cleaning {
  CleanedScan cleaned;
  std::vector<std::uint32_t> order;
  std::optional<OrderedPoints> ordered;  // as they were before outliers were dropped, in that order
  Flags dropped_since;                   // of these

  [[nodiscard]] RangeScan& scan() { return cleaned.scan; }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const { return cleaned.scan.cloud.positions; }

  /// Takes flagged points out, and counts each under the first filter that flags it.
  void drop(const std::vector<Filter>& filters);
  void drop(const std::string& name, Flags flags) { drop({Filter{name, std::move(flags)}}); }
};

void Cleaning::drop(const std::vector<Filter>& filters) {
  Flags any(points().size(), 0);
  std::size_t dropped = 0;
  for (const Filter& filter : filters) {
    std::size_t& count = cleaned.dropped[filter.name];
    for (std::size_t i = 0; i < filter.flags.size(); ++i)
      if (filter.flags[i] != 0 && any[i] == 0) {
        any[i] = 1;
        ++count;
        ++dropped;
      }
  }
  if (dropped == 0) return;
  cleaned.scan = without_points(std::move(cleaned.scan), any);
  if (order.empty()) return;
  if (ordered) {
    if (dropped_since.empty()) dropped_since.assign(ordered->size(), 0);
    std::size_t now = 0;
    for (std::uint8_t& flag : dropped_since)
      if (flag == 0) flag = any[now++];
  }
  std::vector<std::uint32_t> new_index(any.size());
  std::uint32_t kept = 0;
  for (std::size_t i = 0; i < any.size(); ++i) {
    new_index[i] = kept;
    kept += any[i] == 0 ? 1 : 0;
  }
  std::erase_if(order, [&](std::uint32_t i) { return any[i] != 0; });
  for (std::uint32_t& i : order) i = new_index[i];
}

// body(i) for all i on several threads; each writes what belongs to i alone.
template <class Body>
void in_chunks(std::size_t count, const Body& body) {
  constexpr std::size_t chunk = 1 << 14;
  parallel_for(count, chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

Flags not_finite(const std::vector<Eigen::Vector3d>& points) {
  Flags flags(points.size());
  in_chunks(points.size(), [&](std::size_t i) { flags[i] = points[i].allFinite() ? 0 : 1; });
  return flags;
}

// Equal points lie side by side in Morton order, the first of them first.
Flags duplicates(const std::vector<Eigen::Vector3d>& points, const std::vector<std::uint32_t>& order) {
  Flags flags(points.size(), 0);
  in_chunks(order.size(), [&](std::size_t i) {
    if (i > 0 && points[order[i]] == points[order[i - 1]]) flags[order[i]] = 1;
  });
  return flags;
}

bool has_sound_normals(const PointCloud& cloud) {
  return !cloud.empty() && cloud.normals.size() == cloud.size() &&
         std::all_of(cloud.normals.begin(), cloud.normals.end(),
                     [](const Eigen::Vector3f& n) { return n.allFinite() && n.squaredNorm() > 0; });
}

// The kept points in whose plane fit a dropped point took part.
std::vector<std::uint32_t> touched_by_dropped(const OrderedPoints& points, const Flags& dropped,
                                              const std::vector<float>& reaches) {
  // A few points reach very far, and looking around every dropped one that far would take for ever: they are
  // fitted anew in any case.
  constexpr std::size_t enough = 50'000;
  std::vector<float> sorted;
  for (std::size_t i = 0; i < reaches.size(); i += reaches.size() / enough + 1) sorted.push_back(reaches[i]);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  if (!sorted.empty()) std::nth_element(sorted.begin(), middle, sorted.end());
  const float far = sorted.empty() ? 0.0F : 4 * *middle;
  Flags touched(dropped.size(), 0);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::uint32_t i = points.original(k);
    if (dropped[i] == 0) {
      if (reaches[i] > far) touched[i] = 1;
      continue;
    }
    points.within(points.points()[k], static_cast<double>(far), [&](std::uint32_t near) {
      const std::uint32_t other = points.original(near);
      if ((points.points()[near] - points.points()[k]).norm() <= static_cast<double>(reaches[other]))
        touched[other] = 1;
    });
  }
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < touched.size(); ++i)
    if (touched[i] != 0 && dropped[i] == 0) indices.push_back(i);
  return indices;
}

// New normals for some points, fitted to the kept points alone.
void refit(std::vector<Eigen::Vector3f>& normals, const std::vector<std::uint32_t>& which,
           const OrderedPoints& all, const Flags& dropped, const std::vector<Eigen::Vector3d>& points,
           std::size_t neighbors) {
  if (which.empty()) return;
  std::vector<Eigen::Vector3d> queries;
  for (const std::uint32_t i : which) queries.push_back(points[i]);
  const auto fitted = normals_at(all, queries, neighbors, dropped);
  for (std::size_t i = 0; i < which.size(); ++i) normals[which[i]] = fitted[i];
}

// Sparse points and statistical outliers out, unoriented normals in: for a scan without a grid all from one
// pass over the neighbourhoods.
void drop_outliers_and_fit_normals(Cleaning& cleaning, const CleanOptions& options, bool own_normals,
                                   double spacing) {
  RangeScan& scan = cleaning.scan();
  const OrderedPoints& ordered = *cleaning.ordered;
  const bool fit_here = !own_normals && !(scan.grid && spacing > 0);
  const std::size_t outlier_neighbors =
      options.outlier_sigma > 0 ? static_cast<std::size_t>(options.outlier_neighbors) : 0;
  const bool by_lattice = scan.grid && outlier_neighbors > 0;
  const NeighborhoodSpec spec{
      .distance_neighbors = by_lattice ? 0 : outlier_neighbors,
      .normal_neighbors = fit_here ? neighbors_in_disc(options.normal_radius_spacings) : 0,
      .rank =
          options.outlier_radius_spacings > 0 ? static_cast<std::size_t>(options.outlier_radius_points) : 0};
  Neighborhoods found = measure_neighborhoods(ordered, spec);
  const LocalSpacing local(scan, spacing);
  Flags sparse(found.rank_distances.size());
  in_chunks(sparse.size(), [&](std::size_t i) {
    sparse[i] = static_cast<double>(found.rank_distances[i]) >
                        options.outlier_radius_spacings * local.at(cleaning.points()[i])
                    ? 1
                    : 0;
  });
  std::vector<double> distances(found.mean_distances.size());
  in_chunks(distances.size(), [&](std::size_t i) {
    distances[i] =
        static_cast<double>(found.mean_distances[i]) / std::max(local.ratio(cleaning.points()[i]), 1e-12);
  });
  if (by_lattice) distances = lattice_distances(scan, ordered, local, outlier_neighbors);
  const Flags outlier = statistical_outliers(distances, options.outlier_sigma);

  if (fit_here) {
    Flags dropped(scan.cloud.size(), 0);
    for (const Flags* flags : {&std::as_const(sparse), &outlier})
      for (std::size_t i = 0; i < flags->size(); ++i) dropped[i] |= (*flags)[i];
    refit(found.normals, touched_by_dropped(ordered, dropped, found.reaches), ordered, dropped,
          cleaning.points(), spec.normal_neighbors);
    scan.cloud.normals = std::move(found.normals);
  }
  cleaning.drop({{"sparse", sparse}, {"outlier", outlier}});
  if (!own_normals && !fit_here)
    scan.cloud.normals = unoriented_normals(scan, spacing, cleaning.order, options.normal_radius_spacings);
  in_chunks(scan.cloud.normals.size(), [&](std::size_t i) { scan.cloud.normals[i].normalize(); });
}

// Cosine of the angle between each normal and the direction to the scanner.
std::vector<double> incidence_cosines(const RangeScan& scan, const ScanView& view) {
  std::vector<double> cosines(scan.cloud.size(), 1.0);
  if (view.kind == ScanView::Kind::unknown) return cosines;
  in_chunks(cosines.size(), [&](std::size_t i) {
    cosines[i] = scan.cloud.normals[i].cast<double>().dot(view.towards_scanner(scan.cloud.positions[i]));
  });
  return cosines;
}

Flags grazing(const RangeScan& scan, const ScanView& view, double max_incidence_deg) {
  if (max_incidence_deg >= 90) return {};
  const std::vector<double> cosines = incidence_cosines(scan, view);
  const double least = std::cos(max_incidence_deg * std::numbers::pi / 180);
  Flags flags(cosines.size());
  for (std::size_t i = 0; i < cosines.size(); ++i) flags[i] = cosines[i] < least ? 1 : 0;
  return flags;
}

std::vector<float> confidences(const RangeScan& scan, const ScanView& view) {
  const std::vector<double> cosines = incidence_cosines(scan, view);
  const auto& stated = scan.cloud.confidences;
  const LocalSpacing local(scan, 1);
  std::vector<float> result(cosines.size());
  in_chunks(result.size(), [&](std::size_t i) {
    result[i] = static_cast<float>(std::clamp(cosines[i], 0.0, 1.0) /
                                   std::max(1.0, local.ratio(scan.cloud.positions[i]))) *
                (stated.empty() ? 1.0F : std::clamp(stated[i], 0.0F, 1.0F));
  });
  return result;
}

}  // namespace

CleanedScan clean_scan(const RangeScan& raw, const CleanOptions& options, const Progress& progress) {
  Cleaning cleaning{{raw, {}}, {}, {}, {}};
  RangeScan& scan = cleaning.scan();
  progress.update(0, "cleaning " + raw.file);
  cleaning.drop("not_finite", not_finite(scan.cloud.positions));
  cleaning.order = morton_order(scan.cloud.positions);
  cleaning.drop({{"duplicate", duplicates(scan.cloud.positions, cleaning.order)},
                 {"cropped", outside_of_box(scan, options.crop_box)},
                 {"intensity", outside_of_intensities(scan, options.min_intensity, options.max_intensity)}});
  const ScanView view = view_or_lattice_axis(scan);
  std::optional<double> spacing_before = lattice_spacing(scan);
  if (options.support_plane == SupportPlane::drop) {
    if (!spacing_before)
      spacing_before = neighbor_spacing(OrderedPoints(scan.cloud.positions, cleaning.order));
    cleaning.drop("support_plane",
                  support_plane(scan, view, options.support_plane_spacings * *spacing_before));
  }

  progress.update(0.2);
  cleaning.drop("mixed_pixel", mixed_pixels(scan, view, options.mixed_pixel_angle_deg));
  const bool own_normals = options.normals == Normals::automatic && has_sound_normals(scan.cloud);
  cleaning.ordered.emplace(scan.cloud.positions, cleaning.order);
  const double raw_spacing = spacing_before ? *spacing_before : neighbor_spacing(*cleaning.ordered);
  drop_outliers_and_fit_normals(cleaning, options, own_normals, raw_spacing);

  progress.update(0.7);
  if (!own_normals || view.kind != ScanView::Kind::unknown)
    scan.cloud.normals = oriented_normals(std::move(scan.cloud.normals), scan, view, cleaning.order);
  cleaning.drop("grazing", grazing(scan, view, options.max_incidence_deg));
  cleaning.drop("island", small_islands(scan, view, raw_spacing, options.island_gap_spacings,
                                        static_cast<std::size_t>(options.min_island_points), cleaning.order));
  scan.cloud.confidences = confidences(scan, view);
  cleaning.drop("thinned", all_but_best_seen(scan.cloud, options.thin_voxel_spacings * raw_spacing));
  const std::optional<double> spacing = lattice_spacing(scan);
  scan.spacing = spacing ? *spacing : neighbor_spacing(*cleaning.ordered, cleaning.dropped_since);
  progress.update(1);
  return std::move(cleaning.cleaned);
}

}  // namespace drape::ingest
