#include "drape/metrics/surface_tree.hpp"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <iterator>
#include <vector>

#include "drape/base/error.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape::metrics {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 to_cgal(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

Eigen::Vector3d from_cgal(const Kernel::Point_3& p) {
  return {p.x(), p.y(), p.z()};
}

}  // namespace

struct SurfaceTree::Impl {
  Eigen::Vector3d origin;  // distances are computed about it, so that large coordinates cost no digits
  Triangles triangles;
  std::vector<std::uint32_t> faces;  // of the triangles
  Tree tree;
};

SurfaceTree::SurfaceTree(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>()) {
  if (const std::string problem = problem_of(mesh); !problem.empty())
    throw input_error("cannot measure distances to this mesh: {}", problem);
  if (mesh.empty()) throw input_error("cannot measure distances to a mesh without faces");
  impl_->origin = bounding_box(mesh.vertices).center();
  const auto corner = [&](std::uint32_t vertex) { return to_cgal(mesh.vertices[vertex] - impl_->origin); };
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
    if (scaled_face_normal(mesh, i).isZero(0)) continue;
    const Face& f = mesh.faces[i];
    impl_->triangles.emplace_back(corner(f[0]), corner(f[1]), corner(f[2]));
    impl_->faces.push_back(i);
  }
  if (impl_->faces.empty()) throw input_error("cannot measure distances to a mesh whose faces have no area");
  impl_->tree.rebuild(impl_->triangles.cbegin(), impl_->triangles.cend());
  impl_->tree.build();
  // Built here and not by the first query, which several threads may make at once.
  impl_->tree.accelerate_distance_queries();
}

SurfaceTree::~SurfaceTree() = default;
SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;
SurfaceTree& SurfaceTree::operator=(SurfaceTree&&) noexcept = default;

SurfaceTree::Closest SurfaceTree::closest(const Eigen::Vector3d& query) const {
  const Eigen::Vector3d local = query - impl_->origin;
  const auto [point, triangle] = impl_->tree.closest_point_and_primitive(to_cgal(local));
  const Eigen::Vector3d on_surface = from_cgal(point);
  const auto index = std::distance(impl_->triangles.cbegin(), triangle);
  return {on_surface + impl_->origin, (on_surface - local).norm(),
          impl_->faces[static_cast<std::size_t>(index)]};
}

}  // namespace drape::metrics
