#include "cube_cases.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

namespace drape::meshing {
namespace {

constexpr int none = -1;

// The edge between two corners that differ in one bit.
int edge_between(int a, int b) {
  const int low = a & b;
  const int axis = (a ^ b) == 1 ? 0 : ((a ^ b) == 2 ? 1 : 2);
  return 4 * axis + ((low >> ((axis + 1) % 3)) & 1) + 2 * ((low >> ((axis + 2) % 3)) & 1);
}

// The corners of a face, counter-clockwise seen from outside of the cube.
std::array<int, 4> face_corners(int axis, int side) {
  const int base = side << axis;
  const int u = 1 << ((axis + 1) % 3);
  const int v = 1 << ((axis + 2) % 3);
  if (side == 1) return {base, base | u, base | u | v, base | v};
  return {base, base | v, base | u | v, base | u};
}

bool on_face(int edge, int axis, int side) {
  const int a = edge_corner(edge);
  return edge / 4 != axis && ((a >> axis) & 1) == side;
}

bool share_face(int e, int f) {
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      if (on_face(e, axis, side) && on_face(f, axis, side)) return true;
  return false;
}

// From each cut edge to the next one along the surface's outline on the cube's faces.
std::array<int, 12> outline(int inside) {
  std::array<int, 12> next{};
  next.fill(none);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const std::array<int, 4> corners = face_corners(axis, side);
      const auto is_inside = [&](int k) {
        return ((inside >> corners[static_cast<std::size_t>(k & 3)]) & 1) != 0;
      };
      for (int k = 0; k < 4; ++k) {
        if (is_inside(k) || !is_inside(k + 1)) continue;
        // A run of inside corners from k + 1: the outline cuts it off from the rest of the face.
        int last = k + 1;
        while (is_inside(last + 1)) ++last;
        const auto corner = [&](int i) { return corners[static_cast<std::size_t>(i & 3)]; };
        next[static_cast<std::size_t>(edge_between(corner(k), corner(k + 1)))] =
            edge_between(corner(last), corner(last + 1));
      }
    }
  return next;
}

// Whether places a < b of a polygon may have a side between them: one of its own, or none across a cube's
// face.
bool allowed(const std::vector<int>& polygon, std::size_t a, std::size_t b) {
  return b - a == 1 || (a == 0 && b + 1 == polygon.size()) || !share_face(polygon[a], polygon[b]);
}

void add_triangle(const std::vector<int>& polygon, std::size_t a, std::size_t b, std::size_t c,
                  CubeCase& result) {
  result.edges[static_cast<std::size_t>(result.triangles++)] = {static_cast<std::uint8_t>(polygon[a]),
                                                                static_cast<std::uint8_t>(polygon[b]),
                                                                static_cast<std::uint8_t>(polygon[c])};
}

// Triangles over places first .. last of a polygon that is convex in its order; false where every way to
// split it has a side across a cube's face.
bool split(const std::vector<int>& polygon, std::size_t first, std::size_t last, CubeCase& result) {
  if (last - first < 2) return true;
  for (std::size_t middle = first + 1; middle < last; ++middle) {
    if (!allowed(polygon, first, middle) || !allowed(polygon, middle, last)) continue;
    const int before = result.triangles;
    if (split(polygon, first, middle, result) && split(polygon, middle, last, result)) {
      add_triangle(polygon, first, middle, last, result);
      return true;
    }
    result.triangles = before;
  }
  return false;
}

// Triangles from one corner of a polygon to all of its other sides; false where none allows that.
bool fan(std::vector<int> polygon, CubeCase& result) {
  for (std::size_t turn = 0; turn < polygon.size(); ++turn) {
    std::size_t place = 2;
    while (place < polygon.size() && allowed(polygon, 0, place)) ++place;
    if (place == polygon.size()) {
      for (std::size_t k = 1; k + 1 < polygon.size(); ++k) add_triangle(polygon, 0, k, k + 1, result);
      return true;
    }
    std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
  }
  return false;
}

CubeCase make_case(int inside) {
  CubeCase result;
  std::array<int, 12> next = outline(inside);
  for (std::size_t start = 0; start < next.size(); ++start) {
    std::vector<int> polygon;
    for (int edge = static_cast<int>(start); next[static_cast<std::size_t>(edge)] != none;) {
      polygon.push_back(edge);
      const int following = next[static_cast<std::size_t>(edge)];
      next[static_cast<std::size_t>(edge)] = none;
      edge = following;
    }
    if (polygon.empty()) continue;
    // Of the ways to split seven corners some cross themselves, where the cuts lie far from the middles of
    // their edges; triangles with a corner in common do not.
    constexpr std::size_t least_corners_to_cross = 7;
    const bool as_fan = polygon.size() >= least_corners_to_cross && fan(polygon, result);
    [[maybe_unused]] const bool done = as_fan || split(polygon, 0, polygon.size() - 1, result);
    assert(done);
  }
  return result;
}

}  // namespace

const std::array<CubeCase, 256>& cube_cases() {
  static const std::array<CubeCase, 256> cases = [] {
    std::array<CubeCase, 256> all;
    for (int inside = 0; inside < 256; ++inside) all[static_cast<std::size_t>(inside)] = make_case(inside);
    return all;
  }();
  return cases;
}

}  // namespace drape::meshing
