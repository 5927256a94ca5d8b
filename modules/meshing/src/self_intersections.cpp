#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <array>

#include "drape/meshing/mesh_quality.hpp"

namespace drape::meshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

class CrossingTest {
 public:
  explicit CrossingTest(const TriangleMesh& mesh) : mesh_(mesh) {}

  [[nodiscard]] bool operator()(std::uint32_t first, std::uint32_t second) const {
    Face f = mesh_.faces[first];
    Face g = mesh_.faces[second];
    const std::size_t shared = move_shared_to_front(f, g);
    if (degenerate(f) || degenerate(g)) return false;
    if (shared == 3) return true;
    if (shared == 2)  // folded flat onto each other
      return CGAL::coplanar(point(f[0]), point(f[1]), point(f[2]), point(g[2])) &&
             CGAL::coplanar_orientation(point(f[0]), point(f[1]), point(f[2]), point(g[2])) == CGAL::POSITIVE;
    if (shared == 1)
      return CGAL::do_intersect(triangle(f), Kernel::Segment_3(point(g[1]), point(g[2]))) ||
             CGAL::do_intersect(triangle(g), Kernel::Segment_3(point(f[1]), point(f[2])));
    return CGAL::do_intersect(triangle(f), triangle(g));
  }

 private:
  // Afterwards f[k] == g[k] for the first `returned` k.
  static std::size_t move_shared_to_front(Face& f, Face& g) {
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
  [[nodiscard]] Point point(std::uint32_t v) const {
    const Eigen::Vector3d& p = mesh_.vertices[v];
    return {p.x(), p.y(), p.z()};
  }
  [[nodiscard]] bool degenerate(const Face& f) const {
    return CGAL::collinear(point(f[0]), point(f[1]), point(f[2]));
  }
  [[nodiscard]] Kernel::Triangle_3 triangle(const Face& f) const {
    return {point(f[0]), point(f[1]), point(f[2])};
  }

  const TriangleMesh& mesh_;
};

Box box_of(const TriangleMesh& mesh, std::uint32_t face) {
  CGAL::Bbox_3 box;
  for (const std::uint32_t v : mesh.faces[face]) {
    const Eigen::Vector3d& p = mesh.vertices[v];
    box += CGAL::Bbox_3(p.x(), p.y(), p.z(), p.x(), p.y(), p.z());
  }
  return {box, face};
}

}  // namespace

std::vector<FacePair> self_intersecting_pairs(const TriangleMesh& mesh,
                                              const std::vector<std::uint8_t>& tested) {
  std::vector<Box> some;
  std::vector<Box> all;
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
    all.push_back(box_of(mesh, i));
    if (!tested.empty() && tested[i] != 0) some.push_back(all.back());
  }
  const CrossingTest cross(mesh);
  std::vector<FacePair> pairs;
  const auto check = [&](const Box& a, const Box& b) {
    if (a.info() != b.info() && cross(a.info(), b.info())) pairs.push_back(std::minmax(a.info(), b.info()));
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
