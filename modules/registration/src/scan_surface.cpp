#include "scan_surface.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "drape/geometry/spatial_order.hpp"
#include "drape/ingest/point_spacing.hpp"

namespace drape::registration {
namespace {

constexpr std::size_t most_points = 100'000;
constexpr std::size_t least_points = 20;
constexpr double least_normal_cosine = 0.70710678118654752;

bool span_a_surface(const ScanSurface& surface) {
  constexpr std::size_t enough = 5000;
  if (surface.size() < least_points) return false;
  const std::vector<std::uint32_t> sample = surface.sample(enough);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const std::uint32_t i : sample) mean += surface.points()[i];
  mean /= static_cast<double>(sample.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const std::uint32_t i : sample)
    covariance += (surface.points()[i] - mean) * (surface.points()[i] - mean).transpose();
  const Eigen::Vector3d extents = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues();
  return extents[1] > 1e-6 * extents[2];
}

// Median distance of sampled points to the planes of their neighbours, as a deviation where the spacing is
// the median one.
double plane_noise(const ScanSurface& surface, const OrderedPoints& ordered,
                   const ingest::LocalSpacing& local) {
  std::vector<double> distances;
  std::vector<Near> found(5);
  for (const std::uint32_t i : surface.sample(500)) {
    const std::size_t count = ordered.nearest(surface.points()[i], found);
    for (std::size_t n = 1; n < count; ++n) {
      const std::uint32_t j = found[n].index();
      distances.push_back(std::abs(surface.normals()[j].dot(surface.points()[i] - surface.points()[j])) /
                          local.ratio(surface.points()[j]));
    }
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return 1.4826 * *middle / std::sqrt(2.0);  // the difference of two points' errors
}

std::vector<std::uint32_t> every(std::size_t stride, std::span<const std::uint32_t> order) {
  std::vector<std::uint32_t> taken;
  taken.reserve(order.size() / stride + 1);
  for (std::size_t k = 0; k < order.size(); k += stride) taken.push_back(order[k]);
  return taken;
}

}  // namespace

ScanSurface::ScanSurface(const RangeScan& scan, std::span<const Eigen::Vector3f> normals)
    : ScanSurface(scan, scan.spacing > 0 ? scan.spacing : ingest::point_spacing(scan),
                  morton_order(scan.cloud.positions), normals) {}

ScanSurface::ScanSurface(const RangeScan& scan, double scan_spacing, std::span<const std::uint32_t> order,
                         std::span<const Eigen::Vector3f> normals)
    : view_(scan.view),
      field_of_view_(scan),
      box_(bounding_box(scan.cloud.positions)),
      scan_spacing_(scan_spacing),
      stride_(std::max<std::size_t>(1, (scan.cloud.size() + most_points - 1) / most_points)),
      spacing_(scan_spacing_ * std::sqrt(static_cast<double>(stride_))),
      local_spacing_(scan, spacing_),
      ordered_(scan.cloud.positions, every(stride_, order)) {
  const PointCloud& cloud = scan.cloud;
  normals_.reserve(size());
  confidences_.reserve(size());
  for (std::size_t k = 0; k < size(); ++k) {
    const std::uint32_t i = ordered_.original(k);
    normals_.push_back(normals[i].cast<double>().normalized());
    confidences_.push_back(cloud.confidences.empty() ? 1.0 : static_cast<double>(cloud.confidences[i]));
  }
  pixels_.emplace(view_, points(), spacing_);
  is_surface_ = spacing_ > 0 && span_a_surface(*this);
  noise_ = plane_noise(*this, ordered_, local_spacing_);
}

std::vector<std::uint32_t> ScanSurface::sample(std::size_t count) const {
  std::vector<std::uint32_t> indices;
  const std::size_t taken = std::min(count, size());
  for (std::size_t k = 0; k < taken; ++k) indices.push_back(static_cast<std::uint32_t>(k * size() / taken));
  return indices;
}

std::optional<std::uint32_t> ScanSurface::nearest(const Eigen::Vector3d& point, double scale,
                                                  double local_reach) const {
  // Less than a spacing away a point in sight is as good as the nearest, and much faster found.
  const double near = std::min(spacing_ * scale, local_reach);
  const auto seen = pixels_->nearest(point);
  if (seen && seen->squared_distance < near * near) return seen->index;
  const double seen_at = seen ? std::sqrt(seen->squared_distance) : std::numeric_limits<double>::infinity();
  if (const auto found = ordered_.nearest_within(point, std::min(local_reach, seen_at)))
    return found->index();
  return seen_at < local_reach ? std::optional(seen->index) : std::nullopt;
}

std::optional<SurfaceMatch> ScanSurface::match(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                               double reach) const {
  const double scale = local_spacing_.ratio(point);
  const double local_reach = reach * scale;
  if (box_.squaredExteriorDistance(point) >= local_reach * local_reach) return std::nullopt;
  const std::optional<std::uint32_t> found = nearest(point, scale, local_reach);
  if (!found) return std::nullopt;
  const std::uint32_t i = *found;
  if (normals_[i].dot(normal) < least_normal_cosine) return std::nullopt;
  const Eigen::Vector3d offset = point - points()[i];
  const double distance = normals_[i].dot(offset);
  const double aside = std::sqrt(std::max(0.0, offset.squaredNorm() - distance * distance));
  // Between samples the nearest is at most 0.7 spacings aside; a normal that is off adds to it with the
  // distance.
  if (aside > 1.5 * local_spacing_.at(points()[i]) + 0.5 * std::abs(distance)) return std::nullopt;
  return SurfaceMatch{points()[i], normals_[i], distance, confidences_[i], scale};
}

}  // namespace drape::registration
