#include "sight_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape::registration {
namespace {

constexpr double pixel_spacings = 2;
constexpr Eigen::Index void_pixels = 3;
constexpr double facing_cosine = 0.5;
constexpr double most_pixels = 16e6;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

}  // namespace

SightMap::SightMap(const ScanSurface& viewer) : view_(viewer.view()), projection_(viewer.view()) {
  if (view_.kind == ScanView::Kind::unknown || viewer.size() == 0 || !(viewer.spacing() > 0)) return;
  if (view_.kind == ScanView::Kind::direction) {
    pixel_ = pixel_spacings * viewer.spacing();
  } else {
    std::vector<double> ranges;
    for (const auto& p : viewer.points()) ranges.push_back((p - view_.vector).norm());
    const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
    std::nth_element(ranges.begin(), middle, ranges.end());
    median_range_ = *middle;
    if (!(median_range_ > 0)) return;
    pixel_ = pixel_spacings * viewer.spacing() / median_range_;
  }
  Eigen::AlignedBox2d seen;
  for (const auto& p : viewer.points())
    if (const auto sighting = sighting_of(p)) seen.extend(sighting->place);
  if (seen.isEmpty()) return;
  const double coarser = std::max(1.0, std::sqrt((seen.sizes().array() + 1).prod() / most_pixels));
  pixel_ *= coarser;
  corner_ = (seen.min() / coarser).array().floor();
  columns_ = static_cast<Eigen::Index>(seen.sizes().x() / coarser) + 2;
  rows_ = static_cast<Eigen::Index>(seen.sizes().y() / coarser) + 2;
  std::vector<float> nearest(static_cast<std::size_t>(columns_ * rows_), unknown);
  for (const auto& p : viewer.points())
    if (const auto sighting = sighting_of(p)) {
      float& depth = nearest[static_cast<std::size_t>(pixel_at(sighting->place))];
      if (!(depth <= static_cast<float>(sighting->depth))) depth = static_cast<float>(sighting->depth);
    }
  keep_surrounded(nearest);
  find_void(nearest);
}

// Edges may be a pixel off: only inside what was seen, and in front of all that was seen around.
void SightMap::keep_surrounded(const std::vector<float>& nearest) {
  front_.assign(nearest.size(), unknown);
  for (Eigen::Index row = 1; row + 1 < rows_; ++row)
    for (Eigen::Index column = 1; column + 1 < columns_; ++column) {
      float front = std::numeric_limits<float>::max();
      bool surrounded = true;
      for (Eigen::Index r = row - 1; r <= row + 1; ++r)
        for (Eigen::Index c = column - 1; c <= column + 1; ++c) {
          const float depth = nearest[static_cast<std::size_t>(r * columns_ + c)];
          surrounded &= !std::isnan(depth);
          front = std::min(front, depth);
        }
      if (surrounded) front_[static_cast<std::size_t>(row * columns_ + column)] = front;
    }
}

void SightMap::find_void(const std::vector<float>& nearest) {
  void_.assign(nearest.size(), 1);
  for (Eigen::Index row = 0; row < rows_; ++row)
    for (Eigen::Index column = 0; column < columns_; ++column) {
      if (std::isnan(nearest[static_cast<std::size_t>(row * columns_ + column)])) continue;
      for (Eigen::Index r = std::max<Eigen::Index>(0, row - void_pixels);
           r <= std::min(rows_ - 1, row + void_pixels); ++r)
        for (Eigen::Index c = std::max<Eigen::Index>(0, column - void_pixels);
             c <= std::min(columns_ - 1, column + void_pixels); ++c)
          void_[static_cast<std::size_t>(r * columns_ + c)] = 0;
    }
}

double SightMap::in_void_share(std::span<const Eigen::Vector3d> points,
                               std::span<const Eigen::Vector3d> normals,
                               const Rigid3& viewer_from_points) const {
  if (void_.empty()) return 0;
  std::size_t judged = 0;
  std::size_t in_void = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d point = viewer_from_points * points[i];
    if (view_.towards_scanner(point).dot(viewer_from_points.linear() * normals[i]) < facing_cosine) continue;
    const auto sighting = sighting_of(point);
    if (!sighting) continue;
    const std::ptrdiff_t pixel = pixel_at(sighting->place);
    if (pixel < 0) continue;
    ++judged;
    in_void += void_[static_cast<std::size_t>(pixel)];
  }
  return judged >= least_judged ? static_cast<double>(in_void) / static_cast<double>(judged) : 0.0;
}

std::optional<Sighting> SightMap::sighting_of(const Eigen::Vector3d& point) const {
  std::optional<Sighting> sighting = projection_.of(point);
  if (sighting) sighting->place /= pixel_;
  return sighting;
}

std::ptrdiff_t SightMap::pixel_at(const Eigen::Vector2d& place) const {
  const Eigen::Array2d cell = place.array().floor() - corner_;
  if (!(cell.x() >= 0 && cell.y() >= 0 && cell.x() < static_cast<double>(columns_) &&
        cell.y() < static_cast<double>(rows_)))
    return -1;
  return static_cast<Eigen::Index>(cell.y()) * columns_ + static_cast<Eigen::Index>(cell.x());
}

double SightMap::seen_through_share(std::span<const Eigen::Vector3d> points, const Rigid3& viewer_from_points,
                                    double tolerance) const {
  if (front_.empty()) return 0;
  std::size_t judged = 0;
  std::size_t seen_through = 0;
  for (const Eigen::Vector3d& p : points) {
    const auto sighting = sighting_of(viewer_from_points * p);
    if (!sighting) continue;
    const std::ptrdiff_t pixel = pixel_at(sighting->place);
    if (pixel < 0) continue;
    const auto front = static_cast<double>(front_[static_cast<std::size_t>(pixel)]);
    if (std::isnan(front)) continue;
    ++judged;
    // Ranges are less certain where rays have spread.
    const double scale = median_range_ > 0 ? front / median_range_ : 1.0;
    seen_through += sighting->depth < front - tolerance * scale ? 1 : 0;
  }
  return judged >= least_judged ? static_cast<double>(seen_through) / static_cast<double>(judged) : 0.0;
}

}  // namespace drape::registration
