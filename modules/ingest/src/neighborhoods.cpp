#include "neighborhoods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "drape/base/parallel.hpp"
#include "plane_fit.hpp"

namespace drape::ingest {
namespace {

// The `count` nearest of them to the front.
std::span<Near> nearest_of(std::span<Near> near, std::size_t count) {
  if (near.size() <= count) return near;
  std::nth_element(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count) - 1, near.end());
  return near.first(count);
}

float distance_of_furthest(std::span<const Near> near) {
  return std::sqrt(std::max_element(near.begin(), near.end())->squared_distance());
}

float mean_distance(std::span<const Near> near) {
  if (near.size() < 2) return 0;
  float sum = 0;  // the point itself adds nothing
  for (const Near& n : near) sum += std::sqrt(n.squared_distance());
  return sum / static_cast<float>(near.size() - 1);
}

Eigen::Vector3f normal_of(const OrderedPoints& points, const Eigen::Vector3d& center,
                          std::span<const Near> near) {
  PlaneFit plane;
  for (const Near& n : near) plane.add(points.points()[n.index()] - center);
  return plane.normal();
}

}  // namespace

void nearest_kept(const OrderedPoints& points, const Eigen::Vector3d& query, std::size_t count,
                  std::span<const std::uint8_t> dropped, std::vector<Near>& found) {
  for (std::size_t asked = count;; asked *= 2) {
    found.resize(asked);
    found.resize(points.nearest(query, found));
    const bool all = found.size() < asked;
    if (!dropped.empty())
      std::erase_if(found, [&](const Near& n) { return dropped[points.original(n.index())] != 0; });
    if (found.size() >= count) return found.resize(count);
    if (all) return;
  }
}

Neighborhoods measure_neighborhoods(const OrderedPoints& points, const NeighborhoodSpec& spec) {
  Neighborhoods result;
  if (spec.distance_neighbors > 0) result.mean_distances.resize(points.size());
  if (spec.rank > 0) result.rank_distances.resize(points.size());
  if (spec.normal_neighbors > 0) {
    result.normals.resize(points.size());
    result.reaches.resize(points.size());
  }
  const std::size_t most = std::max({spec.distance_neighbors, spec.normal_neighbors, spec.rank});
  if (most == 0) return result;
  points.for_each_neighborhood(most + 1, [&](std::size_t i, std::span<Near> near) {
    const std::uint32_t original = points.original(i);
    const auto measure = [&](std::size_t neighbors) {
      if (neighbors == 0) return;
      near = nearest_of(near, neighbors + 1);  // and the point itself
      if (neighbors == spec.normal_neighbors) {
        result.normals[original] = normal_of(points, points.points()[i], near);
        result.reaches[original] = distance_of_furthest(near);
      }
      if (neighbors == spec.distance_neighbors) result.mean_distances[original] = mean_distance(near);
      if (neighbors == spec.rank)
        result.rank_distances[original] = near.size() == neighbors + 1
                                              ? distance_of_furthest(near)
                                              : std::numeric_limits<float>::infinity();
    };
    // Most neighbours first: the fewer are among them.
    std::array<std::size_t, 3> counts{spec.distance_neighbors, spec.normal_neighbors, spec.rank};
    std::sort(counts.rbegin(), counts.rend());
    for (std::size_t k = 0; k < counts.size(); ++k)
      if (k == 0 || counts[k] != counts[k - 1]) measure(counts[k]);
  });
  return result;
}

std::vector<Eigen::Vector3f> normals_at(const OrderedPoints& points, std::span<const Eigen::Vector3d> queries,
                                        std::size_t neighbors, std::span<const std::uint8_t> dropped) {
  std::vector<Eigen::Vector3f> normals(queries.size());
  constexpr std::size_t chunk = 2048;
  parallel_for(queries.size(), chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<Near> found;
    for (std::size_t i = begin; i < end; ++i) {
      nearest_kept(points, queries[i], neighbors + 1, dropped, found);
      normals[i] = normal_of(points, queries[i], found);
    }
  });
  return normals;
}

}  // namespace drape::ingest
