#include "outline.hpp"

#include <algorithm>
#include <cmath>

namespace drape::registration {
namespace {

constexpr std::ptrdiff_t near_pixels = 2;
constexpr std::ptrdiff_t margin = near_pixels + 1;
constexpr double most_pixels_per_point = 16;
constexpr double facing_cosine = 0.35;

}  // namespace

Outline::Outline(const ScanSurface& viewer) : viewer_(&viewer) {
  const ScanView& view = viewer.view();
  if (view.kind == ScanView::Kind::unknown || viewer.size() == 0 || !viewer.field_of_view().known()) return;
  Eigen::Vector3d ray = Eigen::Vector3d::Zero();
  double range = 0;
  for (const Eigen::Vector3d& p : viewer.points()) {
    ray -= view.towards_scanner(p);
    range += (p - view.vector).norm() / static_cast<double>(viewer.size());
  }
  projection_.emplace(view, ray.normalized());
  pixel_ = view.kind == ScanView::Kind::origin ? viewer.spacing() / range : viewer.spacing();
  lay_out();
  find_outside();
}

void Outline::lay_out() {
  Eigen::AlignedBox2d seen;
  for (const auto& p : viewer_->points())
    if (const auto sighting = projection_->of(p)) seen.extend(sighting->place);
  if (seen.isEmpty()) return;
  const double most = most_pixels_per_point * static_cast<double>(viewer_->size());
  pixel_ = std::max(pixel_, std::sqrt(seen.sizes().prod() / most));
  corner_ = (seen.min().array() / pixel_).floor() - static_cast<double>(margin);
  columns_ = static_cast<std::ptrdiff_t>(seen.sizes().x() / pixel_) + 2 * margin + 2;
  rows_ = static_cast<std::ptrdiff_t>(seen.sizes().y() / pixel_) + 2 * margin + 2;
  cells_.assign(static_cast<std::size_t>(columns_ * rows_), enclosed);
  for (const auto& p : viewer_->points()) {
    const auto sighting = projection_->of(p);
    if (!sighting) continue;
    const Eigen::Array2d cell = cell_of(sighting->place);
    const auto column = static_cast<std::ptrdiff_t>(cell.x());
    const auto row = static_cast<std::ptrdiff_t>(cell.y());
    for (std::ptrdiff_t r = row - near_pixels; r <= row + near_pixels; ++r)
      for (std::ptrdiff_t c = column - near_pixels; c <= column + near_pixels; ++c)
        cells_[static_cast<std::size_t>(r * columns_ + c)] = near;
  }
}

void Outline::find_outside() {
  if (cells_.empty()) return;
  std::vector<std::ptrdiff_t> waiting{0};  // the margin is all outside
  cells_[0] = outside;
  while (!waiting.empty()) {
    const std::ptrdiff_t cell = waiting.back();
    waiting.pop_back();
    const auto reach = [&](std::ptrdiff_t row, std::ptrdiff_t column) {
      if (row < 0 || column < 0 || row >= rows_ || column >= columns_) return;
      std::uint8_t& next = cells_[static_cast<std::size_t>(row * columns_ + column)];
      if (next != enclosed) return;
      next = outside;
      waiting.push_back(row * columns_ + column);
    };
    const std::ptrdiff_t row = cell / columns_;
    const std::ptrdiff_t column = cell % columns_;
    reach(row - 1, column);
    reach(row + 1, column);
    reach(row, column - 1);
    reach(row, column + 1);
  }
}

bool Outline::missed(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const {
  if (cells_.empty()) return false;
  if (!(viewer_->view().towards_scanner(point).dot(normal) > facing_cosine)) return false;
  const auto sighting = projection_->of(point);
  if (!sighting) return false;
  const Eigen::Array2d cell = cell_of(sighting->place);
  const bool inside = cell.x() >= 0 && cell.y() >= 0 && cell.x() < static_cast<double>(columns_) &&
                      cell.y() < static_cast<double>(rows_);
  if (inside && cells_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell.y()) * columns_ +
                                                static_cast<std::ptrdiff_t>(cell.x()))] != outside)
    return false;
  return viewer_->field_of_view().contains(point);
}

double Outline::missed_share(std::span<const Eigen::Vector3d> points,
                             std::span<const Eigen::Vector3d> normals, const Rigid3& viewer_from_points,
                             std::size_t stride) const {
  if (cells_.empty() || points.empty()) return 0;
  std::size_t count = 0;
  std::size_t missed_count = 0;
  for (std::size_t i = 0; i < points.size(); i += stride, ++count)
    missed_count += missed(viewer_from_points * points[i], viewer_from_points.linear() * normals[i]) ? 1 : 0;
  return static_cast<double>(missed_count) / static_cast<double>(count);
}

}  // namespace drape::registration
