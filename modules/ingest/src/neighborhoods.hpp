// What the nearest neighbours of every point tell: one pass over the points in Morton order, so that one
// query finds the part of the tree that it needs still in the cache.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/kd_tree.hpp"

namespace drape::ingest {

/// A copy of the points in Morton order with a tree over it.
class OrderedPoints {
 public:
  /// The points must be finite.
  explicit OrderedPoints(std::span<const Eigen::Vector3d> points);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const { return points_; }
  /// Of points()[i], the index in the caller's order.
  [[nodiscard]] std::uint32_t original(std::size_t i) const { return order_[i]; }
  [[nodiscard]] const KdTree& tree() const { return tree_; }

 private:
  std::vector<std::uint32_t> order_;
  std::vector<Eigen::Vector3d> points_;
  KdTree tree_;
};

/// Unit normal of the plane through points by total least squares (the covariance's least axis); its sign is
/// arbitrary. Points that do not span a plane get some direction across their line, or z.
[[nodiscard]] Eigen::Vector3f plane_normal(std::span<const Eigen::Vector3d> points);

/// Per point, in the caller's order.
struct Neighborhoods {
  std::vector<double> mean_distances;    // to the nearest other points; 0 for a lone point
  std::vector<Eigen::Vector3f> normals;  // of the plane through the nearest points and itself, sign arbitrary
  std::vector<double> reaches;           // distance of the furthest point in that plane fit
};

/// Distances and normals in one pass; a count of 0 leaves out what it belongs to.
[[nodiscard]] Neighborhoods measure_neighborhoods(const OrderedPoints& points, std::size_t distance_neighbors,
                                                  std::size_t normal_neighbors);

/// plane_normal of the `neighbors` points nearest to each of the queries.
[[nodiscard]] std::vector<Eigen::Vector3f> normals_at(const OrderedPoints& points,
                                                      std::span<const Eigen::Vector3d> queries,
                                                      std::size_t neighbors);

}  // namespace drape::ingest
