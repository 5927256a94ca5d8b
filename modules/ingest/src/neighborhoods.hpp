// What the nearest neighbours of every point tell, in one sweep.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/geometry/ordered_points.hpp"

namespace drape::ingest {

/// What to measure; a count of 0 leaves out what it belongs to.
struct NeighborhoodSpec {
  std::size_t distance_neighbors = 0;
  std::size_t normal_neighbors = 0;
  std::size_t rank = 0;
};

/// Per point, in the caller's order.
struct Neighborhoods {
  std::vector<float> mean_distances;     // to the nearest other points; 0 for a lone point
  std::vector<Eigen::Vector3f> normals;  // of the plane through the nearest points and itself, sign arbitrary
  std::vector<float> reaches;            // distance of the furthest point in that plane fit
  std::vector<float> rank_distances;  // of the rank-nearest other point; infinite where there are not so many
};

/// All from one query a point. `points` must be all of the caller's points.
[[nodiscard]] Neighborhoods measure_neighborhoods(const OrderedPoints& points, const NeighborhoodSpec& spec);

/// The `count` points nearest to `query` into `found`, nearest first, without those whose `dropped`, in the
/// caller's order, is not 0; fewer where there are not so many.
void nearest_kept(const OrderedPoints& points, const Eigen::Vector3d& query, std::size_t count,
                  std::span<const std::uint8_t> dropped, std::vector<Near>& found);

/// The normals of the planes through the `neighbors` points nearest to each of the queries, and the nearest
/// of all, sign arbitrary; as if those points were not there whose `dropped`, in the caller's order, is not
/// 0.
[[nodiscard]] std::vector<Eigen::Vector3f> normals_at(const OrderedPoints& points,
                                                      std::span<const Eigen::Vector3d> queries,
                                                      std::size_t neighbors,
                                                      std::span<const std::uint8_t> dropped = {});

}  // namespace drape::ingest
