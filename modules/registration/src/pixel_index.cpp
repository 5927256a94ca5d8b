#include "pixel_index.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace drape::registration {
namespace {

constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();
constexpr double most_pixels_per_point = 16;

double median_range(const ScanView& view, std::span<const Eigen::Vector3d> points) {
  std::vector<double> ranges;
  for (const auto& p : points) ranges.push_back((p - view.vector).norm());
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return *middle;
}

// The middle of what was seen, so that it is not torn apart in the image.
Eigen::Vector3d mean_ray(const ScanView& view, std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : points) sum -= view.towards_scanner(p);
  return sum.norm() > 0 ? sum.normalized() : Eigen::Vector3d::UnitZ();
}

}  // namespace

PixelIndex::PixelIndex(const ScanView& view, std::span<const Eigen::Vector3d> points, double spacing)
    : points_(points) {
  if (view.kind == ScanView::Kind::unknown || points.empty()) return;
  const double pixel =
      view.kind == ScanView::Kind::direction ? spacing : spacing / median_range(view, points);
  if (!(pixel > 0)) return;
  const ViewProjection projection(view, mean_ray(view, points));
  std::vector<Eigen::Vector2d> places(points.size(),
                                      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  Eigen::AlignedBox2d seen;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const auto sighting = projection.of(points[i])) seen.extend(places[i] = sighting->place);
  if (seen.isEmpty()) return;
  const Eigen::Array2d size = (seen.sizes().array() / pixel).floor() + 3;
  if (!(size.prod() <= most_pixels_per_point * static_cast<double>(points.size()) + 4096)) return;
  inverse_pixel_ = 1 / pixel;
  corner_ = seen.min().array() * inverse_pixel_ - 1;
  columns_ = static_cast<int>(size.x());
  rows_ = static_cast<int>(size.y());
  indices_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), nothing);
  projection_ = projection;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (const auto pixel_here = pixel_at(places[i]))
      indices_[static_cast<std::size_t>(pixel_here->y() * columns_ + pixel_here->x())] = i;
}

std::optional<Eigen::Array2i> PixelIndex::pixel_of(const Eigen::Vector3d& point) const {
  const auto sighting = projection_->of(point);
  return sighting ? pixel_at(sighting->place) : std::nullopt;
}

std::optional<Eigen::Array2i> PixelIndex::pixel_at(const Eigen::Vector2d& place) const {
  const Eigen::Array2d pixel = place.array() * inverse_pixel_ - corner_;
  if (!(pixel.x() >= 1 && pixel.y() >= 1 && pixel.x() < columns_ - 1 && pixel.y() < rows_ - 1))
    return std::nullopt;
  return pixel.cast<int>();
}

std::optional<PixelIndex::Found> PixelIndex::nearest(const Eigen::Vector3d& query) const {
  if (!projection_) return std::nullopt;
  const auto pixel = pixel_of(query);
  if (!pixel) return std::nullopt;
  Found best{nothing, std::numeric_limits<double>::infinity()};
  for (int row = pixel->y() - 1; row <= pixel->y() + 1; ++row)
    for (int column = pixel->x() - 1; column <= pixel->x() + 1; ++column) {
      const std::uint32_t i = indices_[static_cast<std::size_t>(row * columns_ + column)];
      if (i == nothing) continue;
      const double squared = (points_[i] - query).squaredNorm();
      if (squared < best.squared_distance) best = {i, squared};
    }
  return best.index == nothing ? std::nullopt : std::optional(best);
}

}  // namespace drape::registration
