#include "drape/metrics/surface_distance.hpp"

#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/metrics/surface_samples.hpp"
#include "drape/metrics/surface_tree.hpp"

namespace drape::metrics {
namespace {

std::vector<Eigen::Vector3d> points_of(const TriangleMesh& mesh, const SurfacePoints& which) {
  if (which.samples == 0) return without_unused_vertices(mesh).vertices;
  std::vector<Eigen::Vector3d> points;
  points.reserve(which.samples);
  for (const SurfaceSample& sample : surface_samples(mesh, which.samples, which.seed))
    points.push_back(sample.point);
  return points;
}

void require_sound(const TriangleMesh& mesh) {
  if (const std::string problem = problem_of(mesh); !problem.empty())
    throw input_error("cannot measure distances from this mesh: {}", problem);
  if (!(surface_area(mesh) > 0)) throw input_error("cannot measure distances from a mesh without area");
}

}  // namespace

std::vector<double> distances_to_surface(std::span<const Eigen::Vector3d> points,
                                         const TriangleMesh& surface) {
  if (points.empty()) throw input_error("cannot measure the distance of no points");
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      throw input_error("cannot measure the distance of point {}: a coordinate is not a finite number", i);
  const SurfaceTree tree(surface);
  std::vector<double> distances(points.size());
  parallel_for(points.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) distances[i] = tree.closest(points[i]).distance;
  });
  return distances;
}

Distribution surface_distance(std::span<const Eigen::Vector3d> points, const TriangleMesh& surface) {
  return distribution(distances_to_surface(points, surface));
}

Distribution surface_distance(const TriangleMesh& from, const TriangleMesh& to, const SurfacePoints& points) {
  require_sound(from);
  return surface_distance(points_of(from, points), to);
}

TwoWayDistance two_way_distance(const TriangleMesh& made, const TriangleMesh& truth,
                                const SurfacePoints& points) {
  return {surface_distance(made, truth, points), surface_distance(truth, made, points)};
}

}  // namespace drape::metrics
