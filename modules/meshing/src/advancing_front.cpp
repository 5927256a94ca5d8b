#include "advancing_front.hpp"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>

#include <array>
#include <iterator>

#include "drape/base/random.hpp"

namespace drape::meshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// Takes long triangles out of the competition, so that the front stops at gaps instead of bridging them.
struct BoundedEdge {
  double longest_squared;

  template <class Front, class Cell>
  double operator()(const Front& front, const Cell& cell, const int& index) const {
    for (int k = 1; k < 4; ++k) {
      const Point& a = cell->vertex((index + k) % 4)->point();
      const Point& b = cell->vertex((index + k % 3 + 1) % 4)->point();
      if (CGAL::squared_distance(a, b) > longest_squared) return front.infinity();
    }
    return front.smallest_radius_delaunay_sphere(cell, index);
  }
};

// The front takes equally good triangles in the order of their addresses in memory. Samples on a regular
// lattice have many such ties, so the front is computed on samples that are off by an invisible amount.
std::vector<Point> without_ties(const PointCloud& samples, double longest_edge) {
  const double most = 1e-7 * longest_edge;
  std::vector<Point> points;
  points.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Rng rng(item_seed(0, i));
    const Eigen::Vector3d& p = samples.positions[i];
    const double x = p.x() + rng.uniform(-most, most);
    const double y = p.y() + rng.uniform(-most, most);
    points.emplace_back(x, y, p.z() + rng.uniform(-most, most));
  }
  return points;
}

}  // namespace

TriangleMesh advancing_front_mesh(const PointCloud& samples, double longest_edge) {
  CGAL::get_default_random() = CGAL::Random(0);  // CGAL seeds it by the time of day
  const std::vector<Point> points = without_ties(samples, longest_edge);
  std::vector<std::array<std::size_t, 3>> triples;
  CGAL::advancing_front_surface_reconstruction(points.begin(), points.end(), std::back_inserter(triples),
                                               BoundedEdge{longest_edge * longest_edge});
  TriangleMesh mesh;
  mesh.vertices = samples.positions;
  mesh.faces.reserve(triples.size());
  for (const auto& t : triples)
    mesh.faces.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                          static_cast<std::uint32_t>(t[2])});
  return mesh;
}

}  // namespace drape::meshing
