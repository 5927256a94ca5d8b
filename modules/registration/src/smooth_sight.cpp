#include "smooth_sight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drape::registration {
namespace {

constexpr double pixel_spacings = 2;
constexpr double most_pixels_per_point = 4;
constexpr std::ptrdiff_t void_pixels = 3;
constexpr std::ptrdiff_t margin = void_pixels + 2;
constexpr double patch_radius_voxels = 2.5;
constexpr double facing_cosine = 0.5;
constexpr double agreeing_cosine = 0.5;
constexpr double tolerance_voxels = 0.3;
constexpr double tolerance_deviations = 0.8;

Eigen::Vector3d mean_ray(const ScanSurface& surface) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : surface.points()) sum -= surface.view().towards_scanner(p);
  return sum.norm() > 0 ? sum.normalized() : Eigen::Vector3d::UnitZ();
}

double median_range(const ScanSurface& surface) {
  std::vector<double> ranges;
  for (const auto& p : surface.points()) ranges.push_back((p - surface.view().vector).norm());
  const auto middle = ranges.begin() + static_cast<std::ptrdiff_t>(ranges.size() / 2);
  std::nth_element(ranges.begin(), middle, ranges.end());
  return *middle;
}

}  // namespace

SmoothSight::SmoothSight(const ScanSurface& viewer, const CoarseScan& coarse)
    : viewer_(&viewer), center_(viewer.box().center()) {
  if (viewer.view().kind == ScanView::Kind::unknown || viewer.size() == 0 || !(viewer.spacing() > 0)) return;
  pixel_ = pixel_spacings * viewer.spacing();
  if (viewer.view().kind == ScanView::Kind::origin) {
    median_range_ = median_range(viewer);
    if (!(median_range_ > 0)) return;
    pixel_ /= median_range_;
  }
  projection_.emplace(viewer.view(), mean_ray(viewer));
  lay_out();
  fill(coarse);
  find_outside();
}

void SmoothSight::lay_out() {
  Eigen::AlignedBox2d seen;
  for (const auto& p : viewer_->points())
    if (const auto sighting = projection_->of(p)) seen.extend(sighting->place);
  if (seen.isEmpty()) return;
  const double most = most_pixels_per_point * static_cast<double>(viewer_->size());
  pixel_ = std::max(pixel_, std::sqrt(seen.sizes().prod() / most));
  corner_ = (seen.min().array() / pixel_).floor() - static_cast<double>(margin);
  columns_ = static_cast<std::ptrdiff_t>(seen.sizes().x() / pixel_) + 2 * margin + 2;
  rows_ = static_cast<std::ptrdiff_t>(seen.sizes().y() / pixel_) + 2 * margin + 2;
  pixels_.assign(static_cast<std::size_t>(columns_ * rows_), {});
}

Eigen::Array2d SmoothSight::cell_of(const Eigen::Vector2d& place) const {
  return (place.array() / pixel_).floor() - corner_;
}

void SmoothSight::fill(const CoarseScan& coarse) {
  if (pixels_.empty()) return;
  for (const Eigen::Vector3d& p : viewer_->points()) {
    const auto sighting = projection_->of(p);
    const auto nearest = coarse.nearest(p);
    if (!sighting || !nearest) continue;
    const Eigen::Array2d cell = cell_of(sighting->place);
    Pixel& pixel = pixels_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell.y()) * columns_ +
                                                    static_cast<std::ptrdiff_t>(cell.x()))];
    const Eigen::Vector3d& normal = coarse.normals()[*nearest];
    const Eigen::Vector3d smooth = p - normal.dot(p - coarse.points()[*nearest]) * normal;
    pixel.point += (smooth - center_).cast<float>();
    pixel.normal += normal.cast<float>();
    pixel.count += 1;
  }
  for (std::ptrdiff_t row = margin; row < rows_ - margin; ++row)
    for (std::ptrdiff_t column = margin; column < columns_ - margin; ++column) {
      Pixel& pixel = pixels_[static_cast<std::size_t>(row * columns_ + column)];
      if (pixel.count == 0) continue;
      pixel.point /= pixel.count;
      pixel.normal.normalize();
      for (std::ptrdiff_t r = row - void_pixels; r <= row + void_pixels; ++r)
        for (std::ptrdiff_t c = column - void_pixels; c <= column + void_pixels; ++c)
          pixels_[static_cast<std::size_t>(r * columns_ + c)].near = true;
    }
}

void SmoothSight::find_outside() {
  if (pixels_.empty()) return;
  std::vector<std::ptrdiff_t> waiting{0};  // the margin is all outside
  pixels_[0].outside = true;
  while (!waiting.empty()) {
    const std::ptrdiff_t pixel = waiting.back();
    waiting.pop_back();
    const std::ptrdiff_t row = pixel / columns_;
    const std::ptrdiff_t column = pixel % columns_;
    const auto reach = [&](std::ptrdiff_t r, std::ptrdiff_t c) {
      if (r < 0 || c < 0 || r >= rows_ || c >= columns_) return;
      Pixel& next = pixels_[static_cast<std::size_t>(r * columns_ + c)];
      if (next.near || next.outside) return;
      next.outside = true;
      waiting.push_back(r * columns_ + c);
    };
    reach(row - 1, column);
    reach(row + 1, column);
    reach(row, column - 1);
    reach(row, column + 1);
  }
}

// In front is what lies before the planes of all pixels around: beside an edge it is behind the nearer side.
SmoothSight::Seen SmoothSight::judge_surface(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                             std::size_t pixel, double tolerance) const {
  const Eigen::Vector3f local = (point - center_).cast<float>();
  const Eigen::Vector3f towards = viewer_->view().towards_scanner(point).cast<float>();
  const Eigen::Vector3f facing = normal.cast<float>();
  float least = std::numeric_limits<float>::max();
  float closest = least;
  float cosine = 0;
  for (std::ptrdiff_t r = -1; r <= 1; ++r)
    for (std::ptrdiff_t c = -1; c <= 1; ++c) {
      const Pixel& seen =
          pixels_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(pixel) + r * columns_ + c)];
      if (seen.count == 0) return Seen::nothing_told;
      const Eigen::Vector3f step = local - seen.point;
      const float distance = seen.normal.dot(step);
      least = std::min({least, distance, towards.dot(step)});
      if (std::abs(distance) < closest) {
        closest = std::abs(distance);
        cosine = seen.normal.dot(facing);
      }
    }
  if (static_cast<double>(least) > tolerance) return Seen::in_front;
  const bool agrees = static_cast<double>(closest)<tolerance&& static_cast<double>(cosine)> agreeing_cosine;
  return agrees ? Seen::agreeing : Seen::nothing_told;
}

SmoothSight::Seen SmoothSight::judge(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                     double tolerance) const {
  const auto sighting = projection_->of(point);
  if (!sighting) return Seen::nothing_told;
  const Eigen::Array2d cell = cell_of(sighting->place);
  const bool inside = cell.x() >= 1 && cell.y() >= 1 && cell.x() < static_cast<double>(columns_ - 1) &&
                      cell.y() < static_cast<double>(rows_ - 1);
  const std::size_t pixel = inside
                                ? static_cast<std::size_t>(static_cast<std::ptrdiff_t>(cell.y()) * columns_ +
                                                           static_cast<std::ptrdiff_t>(cell.x()))
                                : 0;
  if (!inside || !pixels_[pixel].near) {
    return (!inside || pixels_[pixel].outside) && viewer_->field_of_view().contains(point) &&
                   viewer_->view().towards_scanner(point).dot(normal) > facing_cosine
               ? Seen::in_void
               : Seen::nothing_told;
  }
  // Ranges are less certain where rays have spread.
  const double scale = median_range_ > 0 ? std::max(1.0, sighting->depth / median_range_) : 1.0;
  return judge_surface(point, normal, pixel, scale * tolerance);
}

SightShares SmoothSight::compare(const CoarseScan& source, const Rigid3& viewer_from_source,
                                 double tolerance) const {
  SightShares shares;
  if (pixels_.empty() || source.size() == 0) return shares;
  std::vector<Seen> seen(source.size());
  for (std::size_t i = 0; i < source.size(); ++i)
    seen[i] = judge(viewer_from_source * source.points()[i],
                    viewer_from_source.linear() * source.normals()[i], tolerance);
  for (std::size_t i = 0; i < source.size(); ++i) {
    shares.agreeing += seen[i] == Seen::agreeing ? 1 : 0;
    if (seen[i] != Seen::in_front && seen[i] != Seen::in_void) continue;
    if (mostly(seen, seen[i], source, i)) (seen[i] == Seen::in_front ? shares.in_front : shares.in_void) += 1;
  }
  const auto count = static_cast<double>(source.size());
  return {shares.agreeing / count, shares.in_front / count, shares.in_void / count};
}

double SmoothSight::in_front_share(const CoarseScan& source, const Rigid3& viewer_from_source,
                                   double tolerance) const {
  if (pixels_.empty() || source.size() == 0) return 0;
  std::size_t in_front = 0;
  for (std::size_t i = 0; i < source.size(); ++i)
    in_front += judge(viewer_from_source * source.points()[i],
                      viewer_from_source.linear() * source.normals()[i], tolerance) == Seen::in_front
                    ? 1
                    : 0;
  return static_cast<double>(in_front) / static_cast<double>(source.size());
}

// Whether most points near one are seen as it is.
bool SmoothSight::mostly(const std::vector<Seen>& seen, Seen as, const CoarseScan& scan, std::size_t which) {
  const NeighborLists& neighbors = scan.neighbors();
  const auto radius = static_cast<float>(patch_radius_voxels * scan.voxel());
  int near = 1;
  int same = 1;
  for (std::uint32_t k = neighbors.begin[which]; k < neighbors.begin[which + 1]; ++k) {
    if (!(neighbors.distance[k] < radius)) continue;
    ++near;
    same += seen[neighbors.index[k]] == as ? 1 : 0;
  }
  return 2 * same > near;
}

double smooth_tolerance(const CoarseScan& a, const CoarseScan& b) {
  return std::max(tolerance_voxels * a.voxel(), tolerance_deviations * std::max(a.noise(), b.noise()));
}

}  // namespace drape::registration
