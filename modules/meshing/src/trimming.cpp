#include "trimming.hpp"

#include <algorithm>

#include "drape/base/parallel.hpp"
#include "drape/geometry/kd_tree.hpp"

namespace drape::meshing {
namespace {

constexpr int teeth_rounds = 3;

bool near(const KdTree& tree, const Eigen::Vector3d& point, double distance) {
  Neighbor found{};
  return tree.nearest(point, {&found, 1}) == 1 && found.squared_distance <= distance * distance;
}

// A face much smaller than the distance is supported if its vertices are.
bool inner_points_near(const TriangleMesh& mesh, const Face& f, const KdTree& tree, double distance) {
  const Eigen::Vector3d& a = mesh.vertices[f[0]];
  const Eigen::Vector3d& b = mesh.vertices[f[1]];
  const Eigen::Vector3d& c = mesh.vertices[f[2]];
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  if (longest <= distance * distance) return true;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d((a + b + c) / 3), Eigen::Vector3d((a + b) / 2),
                                   Eigen::Vector3d((b + c) / 2), Eigen::Vector3d((c + a) / 2)})
    if (!near(tree, p, distance)) return false;
  // Between these points lies at most a quarter of the longest edge: a larger face is no surface of samples.
  return longest <= 16 * distance * distance;
}

}  // namespace

Cleaned trimmed_to_samples(const TriangleMesh& mesh, const PointCloud& samples, double distance) {
  const KdTree tree(samples.positions);
  std::vector<std::uint8_t> supported(mesh.vertices.size());
  parallel_for(supported.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) supported[v] = near(tree, mesh.vertices[v], distance) ? 1 : 0;
  });
  std::vector<std::uint8_t> keep(mesh.faces.size());
  parallel_for(keep.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Face& f = mesh.faces[i];
      const bool vertices = supported[f[0]] != 0 && supported[f[1]] != 0 && supported[f[2]] != 0;
      keep[i] = vertices && inner_points_near(mesh, f, tree, distance) ? 1 : 0;
    }
  });
  const auto removed = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), 0));
  if (removed == 0) return {mesh, 0};
  Cleaned trimmed = without_border_teeth(with_faces(mesh, keep), teeth_rounds);
  trimmed.removed += removed;
  return trimmed;
}

}  // namespace drape::meshing
