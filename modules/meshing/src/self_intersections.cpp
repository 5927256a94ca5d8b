#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <utility>

#include "drape/meshing/mesh_quality.hpp"
#include "face_crossing.hpp"

namespace drape::meshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

// Afterwards f[k] == g[k] for the first `returned` k.
std::size_t move_shared_to_front(Face& f, Face& g) {
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = shared; j < 3; ++j)
      if (f[i] == g[j]) {
        std::swap(f[i], f[shared]);
        std::swap(g[j], g[shared]);
        ++shared;
        break;
      }
  return shared;
}

Box box_of(const TriangleMesh& mesh, std::uint32_t face) {
  CGAL::Bbox_3 box;
  for (const std::uint32_t v : mesh.faces[face]) {
    const Eigen::Vector3d& p = mesh.vertices[v];
    box += CGAL::Bbox_3(p.x(), p.y(), p.z(), p.x(), p.y(), p.z());
  }
  return {box, face};
}

}  // namespace

bool faces_cross(const TriangleMesh& mesh, Face f, Face g) {
  const auto point = [&](std::uint32_t v) {
    const Eigen::Vector3d& p = mesh.vertices[v];
    return Point(p.x(), p.y(), p.z());
  };
  const std::size_t shared = move_shared_to_front(f, g);
  const Kernel::Triangle_3 first(point(f[0]), point(f[1]), point(f[2]));
  const Kernel::Triangle_3 second(point(g[0]), point(g[1]), point(g[2]));
  if (first.is_degenerate() || second.is_degenerate()) return false;
  if (shared == 3) return true;
  if (shared == 2)  // folded flat onto each other
    return CGAL::coplanar(first[0], first[1], first[2], second[2]) &&
           CGAL::coplanar_orientation(first[0], first[1], first[2], second[2]) == CGAL::POSITIVE;
  if (shared == 1)
    return CGAL::do_intersect(first, Kernel::Segment_3(second[1], second[2])) ||
           CGAL::do_intersect(second, Kernel::Segment_3(first[1], first[2]));
  return CGAL::do_intersect(first, second);
}

std::vector<FacePair> self_intersecting_pairs(const TriangleMesh& mesh,
                                              const std::vector<std::uint8_t>& tested) {
  std::vector<Box> some;
  std::vector<Box> all;
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
    all.push_back(box_of(mesh, i));
    if (!tested.empty() && tested[i] != 0) some.push_back(all.back());
  }
  std::vector<FacePair> pairs;
  const auto check = [&](const Box& a, const Box& b) {
    if (a.info() != b.info() && faces_cross(mesh, mesh.faces[a.info()], mesh.faces[b.info()]))
      pairs.push_back(std::minmax(a.info(), b.info()));
  };
  if (tested.empty())
    CGAL::box_self_intersection_d(all.begin(), all.end(), check);
  else
    CGAL::box_intersection_d(some.begin(), some.end(), all.begin(), all.end(), check);
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace drape::meshing
