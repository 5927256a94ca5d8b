#include "nested_holes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace drape::meshing {
namespace {

// How far an island may lie from the plane of the hole round it, in square roots of the hole's area: the cap
// of a half sphere lies half a root off.
constexpr double island_height = 0.5;

// A loop seen along the normal of a plane.
class Outline {
 public:
  Outline(const TriangleMesh& mesh, const std::vector<std::uint32_t>& loop)
      : plane_(loop_plane(mesh, loop)), x_(plane_.normal.unitOrthogonal()), y_(plane_.normal.cross(x_)) {
    for (const std::uint32_t v : loop) corners_.push_back(seen(mesh.vertices[v]));
  }
  [[nodiscard]] const LoopPlane& plane() const { return plane_; }
  [[nodiscard]] bool contains(const Eigen::Vector3d& point) const {
    const Eigen::Vector2d p = seen(point);
    bool inside = false;
    for (std::size_t i = 0, j = corners_.size() - 1; i < corners_.size(); j = i++) {
      const Eigen::Vector2d& a = corners_[i];
      const Eigen::Vector2d& b = corners_[j];
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()))
        inside = !inside;
    }
    return inside;
  }

 private:
  [[nodiscard]] Eigen::Vector2d seen(const Eigen::Vector3d& p) const {
    return {x_.dot(p - plane_.point), y_.dot(p - plane_.point)};
  }
  LoopPlane plane_;
  Eigen::Vector3d x_;
  Eigen::Vector3d y_;
  std::vector<Eigen::Vector2d> corners_;
};

bool share_a_vertex(std::vector<std::uint32_t> a, std::vector<std::uint32_t> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  std::vector<std::uint32_t> shared;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(shared));
  return !shared.empty();
}

}  // namespace

std::vector<std::size_t> loops_around(const TriangleMesh& mesh, const Pieces& pieces,
                                      const std::vector<BoundaryLoop>& loops, const std::vector<Hole>& holes,
                                      double spacing) {
  std::vector<std::size_t> around(loops.size());
  std::iota(around.begin(), around.end(), std::size_t{0});
  for (std::size_t outer = 0; outer < loops.size(); ++outer) {
    if (!loops[outer].closed || !(holes[outer].area > 0)) continue;
    const Outline outline(mesh, loops[outer].vertices);
    const std::uint32_t outer_piece = pieces.of_vertex(loops[outer].vertices[0]);
    for (std::size_t inner = 0; inner < loops.size(); ++inner) {
      if (inner == outer || !loops[inner].closed || holes[inner].area >= holes[outer].area) continue;
      // Of several round it, the least.
      if (around[inner] != inner && holes[around[inner]].area <= holes[outer].area) continue;
      if ((holes[inner].center - holes[outer].center).norm() > holes[outer].length / 2) continue;
      const std::uint32_t piece = pieces.of_vertex(loops[inner].vertices[0]);
      const bool island = piece != outer_piece && is_sheet_rim(holes[inner], pieces.area(piece));
      // The rim of a sheet runs round all the holes in it: what is between them is the sheet.
      if (piece == outer_piece && is_sheet_rim(holes[outer], pieces.area(piece))) continue;
      const double reach = island
                               ? island_height * std::sqrt(holes[outer].area)
                               : std::max(2 * spacing, 2 * (holes[outer].flatness + holes[inner].flatness));
      const LoopPlane& plane = outline.plane();
      if (std::abs(plane.normal.dot(holes[inner].center - plane.point)) > reach) continue;
      if (loop_plane(mesh, loops[inner].vertices).normal.dot(plane.normal) > -0.7) continue;
      if (std::all_of(loops[inner].vertices.begin(), loops[inner].vertices.end(),
                      [&](std::uint32_t v) { return outline.contains(mesh.vertices[v]); }) &&
          !share_a_vertex(loops[outer].vertices, loops[inner].vertices))
        around[inner] = outer;
    }
  }
  // What lies in a loop that itself lies in another is a hole of an island: it is filled on its own.
  for (std::size_t i = 0; i < around.size(); ++i)
    if (around[i] != i && around[around[i]] != around[i]) around[i] = i;
  return around;
}

BridgedLoop bridged(const TriangleMesh& mesh, const std::vector<std::uint32_t>& outer,
                    const std::vector<std::uint32_t>& inner) {
  std::size_t o = 0;
  std::size_t n = 0;
  double least = std::numeric_limits<double>::infinity();
  const auto at = [](const std::vector<std::uint32_t>& loop, std::size_t i) { return loop[i % loop.size()]; };
  for (std::size_t i = 0; i < outer.size(); ++i)
    for (std::size_t k = 0; k < inner.size(); ++k) {
      // Both sides of the bridge.
      const double length = (mesh.vertices[at(outer, i + 1)] - mesh.vertices[inner[k]]).squaredNorm() +
                            (mesh.vertices[outer[i]] - mesh.vertices[at(inner, k + 1)]).squaredNorm();
      if (length < least) {
        least = length;
        o = i;
        n = k;
      }
    }
  BridgedLoop result;
  const std::uint32_t a = outer[o];
  const std::uint32_t b = at(outer, o + 1);
  const std::uint32_t c = inner[n];
  const std::uint32_t d = at(inner, n + 1);
  result.bridge = {{a, b, c}, {a, c, d}};
  for (std::size_t i = 1; i <= outer.size(); ++i) result.loop.push_back(at(outer, o + i));
  for (std::size_t k = 1; k <= inner.size(); ++k) result.loop.push_back(at(inner, n + k));
  return result;
}

}  // namespace drape::meshing
