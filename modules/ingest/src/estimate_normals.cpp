#include "drape/ingest/estimate_normals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "drape/geometry/spatial_order.hpp"
#include "drape/ingest/point_spacing.hpp"
#include "lattice_normals.hpp"
#include "lattice_view.hpp"
#include "neighborhoods.hpp"
#include "normal_orientation.hpp"
#include "surface_normals.hpp"

namespace drape::ingest {
namespace {

OrderedPoints ordered_points(const std::vector<Eigen::Vector3d>& points,
                             std::span<const std::uint32_t> order) {
  return {points, std::vector<std::uint32_t>(order.begin(), order.end())};
}

}  // namespace

std::size_t neighbors_in_disc(double radius_spacings) {
  constexpr double least = 6;
  return static_cast<std::size_t>(
      std::max(least, std::round(std::numbers::pi * radius_spacings * radius_spacings)));
}

std::vector<Eigen::Vector3f> unoriented_normals(const RangeScan& scan, double spacing,
                                                std::span<const std::uint32_t> order,
                                                double radius_spacings) {
  const auto& points = scan.cloud.positions;
  const std::size_t neighbors = neighbors_in_disc(radius_spacings);
  if (!scan.grid || !(spacing > 0))
    return measure_neighborhoods(ordered_points(points, order), {.normal_neighbors = neighbors}).normals;

  std::vector<Eigen::Vector3f> normals = lattice_normals(scan, LocalSpacing(scan, spacing), radius_spacings);
  std::vector<std::size_t> left;
  std::vector<Eigen::Vector3d> queries;
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (normals[i].isZero()) {
      left.push_back(i);
      queries.push_back(points[i]);
    }
  if (left.empty()) return normals;
  const std::vector<Eigen::Vector3f> found = normals_at(ordered_points(points, order), queries, neighbors);
  for (std::size_t i = 0; i < left.size(); ++i) normals[left[i]] = found[i];
  return normals;
}

std::vector<Eigen::Vector3f> oriented_normals(std::vector<Eigen::Vector3f> normals, const RangeScan& scan,
                                              const ScanView& view, std::span<const std::uint32_t> order) {
  if (view.kind != ScanView::Kind::unknown)
    return oriented_to_view(std::move(normals), scan.cloud.positions, view);
  return oriented_by_spanning_tree(std::move(normals), ordered_points(scan.cloud.positions, order));
}

std::vector<Eigen::Vector3f> estimate_normals(const RangeScan& scan, double radius_spacings) {
  const double spacing = scan.spacing > 0 ? scan.spacing : point_spacing(scan);
  return estimate_normals(scan, spacing, morton_order(scan.cloud.positions), radius_spacings);
}

std::vector<Eigen::Vector3f> estimate_normals(const RangeScan& scan, double spacing,
                                              std::span<const std::uint32_t> order, double radius_spacings) {
  return oriented_normals(unoriented_normals(scan, spacing, order, radius_spacings), scan,
                          view_or_lattice_axis(scan), order);
}

}  // namespace drape::ingest
