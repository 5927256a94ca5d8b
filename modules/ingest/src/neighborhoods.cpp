#include "neighborhoods.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"
#include "drape/ingest/spatial_order.hpp"

namespace drape::ingest {
namespace {

constexpr std::size_t chunk = 2048;

std::vector<Eigen::Vector3d> reordered(std::span<const Eigen::Vector3d> points,
                                       const std::vector<std::uint32_t>& order) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(order.size());
  for (const std::uint32_t i : order) result.push_back(points[i]);
  return result;
}

}  // namespace

OrderedPoints::OrderedPoints(std::span<const Eigen::Vector3d> points)
    : order_(morton_order(points)), points_(reordered(points, order_)), tree_(points_) {}

Eigen::Vector3f plane_normal(std::span<const Eigen::Vector3d> points) {
  if (points.empty()) return Eigen::Vector3f::UnitZ();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& p : points) mean += p - points[0];
  mean = points[0] + mean / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const auto& p : points) covariance += (p - mean) * (p - mean).transpose();
  if (!(covariance.trace() > 0)) return Eigen::Vector3f::UnitZ();
  covariance /= covariance.trace();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  Eigen::Vector3d normal = solver.eigenvectors().col(0);
  // The closed form gives no sound vector for a line of points: the two small eigenvalues are equal there.
  if (!normal.allFinite() || std::abs(normal.norm() - 1) > 1e-6 || solver.eigenvalues()[1] < 1e-9)
    normal = solver.compute(covariance).eigenvectors().col(0);
  return normal.normalized().cast<float>();
}

Neighborhoods measure_neighborhoods(const OrderedPoints& points, std::size_t distance_neighbors,
                                    std::size_t normal_neighbors) {
  Neighborhoods result;
  if (distance_neighbors > 0) result.mean_distances.resize(points.size());
  if (normal_neighbors > 0) {
    result.normals.resize(points.size());
    result.reaches.resize(points.size());
  }
  const std::size_t wanted = std::max(distance_neighbors + 1, normal_neighbors + 1);
  parallel_for(points.size(), chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbor> found(wanted);
    std::vector<Eigen::Vector3d> around;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t count = points.tree().nearest(points.points()[i], found);
      const std::uint32_t original = points.original(i);
      if (distance_neighbors > 0) {
        const std::size_t last = std::min(count, distance_neighbors + 1);  // found[0] is the point itself
        double sum = 0;
        for (std::size_t n = 1; n < last; ++n) sum += std::sqrt(found[n].squared_distance);
        result.mean_distances[original] = last > 1 ? sum / static_cast<double>(last - 1) : 0.0;
      }
      if (normal_neighbors > 0) {
        const std::size_t last = std::min(count, normal_neighbors + 1);
        around.clear();
        for (std::size_t n = 0; n < last; ++n) around.push_back(points.points()[found[n].index]);
        result.normals[original] = plane_normal(around);
        result.reaches[original] = std::sqrt(found[last - 1].squared_distance);
      }
    }
  });
  return result;
}

std::vector<Eigen::Vector3f> normals_at(const OrderedPoints& points, std::span<const Eigen::Vector3d> queries,
                                        std::size_t neighbors) {
  std::vector<Eigen::Vector3f> normals(queries.size());
  parallel_for(queries.size(), chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Neighbor> found(neighbors + 1);
    std::vector<Eigen::Vector3d> around;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t count = points.tree().nearest(queries[i], found);
      around.clear();
      for (std::size_t n = 0; n < count; ++n) around.push_back(points.points()[found[n].index]);
      normals[i] = plane_normal(around);
    }
  });
  return normals;
}

}  // namespace drape::ingest
