#include "faces_without_area.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "vertex_faces.hpp"

namespace drape::meshing {
namespace {

// A face this much lower than its longest edge is long has no area: coordinates carry some 16 digits.
constexpr double least_height = 1e-12;

double squared_length(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b) {
  return (mesh.vertices[a] - mesh.vertices[b]).squaredNorm();
}

bool has_area(const TriangleMesh& mesh, const Face& f) {
  const Eigen::Vector3d& a = mesh.vertices[f[0]];
  const double doubled = (mesh.vertices[f[1]] - a).cross(mesh.vertices[f[2]] - a).norm();
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, squared_length(mesh, f[k], f[(k + 1) % 3]));
  return doubled > least_height * longest;
}

std::vector<std::uint32_t> flat_faces(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> flat;
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i)
    if (!has_area(mesh, mesh.faces[i])) flat.push_back(i);
  return flat;
}

// One walk over the faces without area. What a change touches is left alone for the rest of the walk, as
// what is known of its surroundings is out of date.
class Walk {
 public:
  explicit Walk(TriangleMesh& mesh)
      : mesh_(mesh), around_(mesh), touched_(mesh.vertices.size(), 0), keep_(mesh.faces.size(), 1) {}

  void mend(std::uint32_t face) {
    const Face f = mesh_.faces[face];
    if (std::any_of(f.begin(), f.end(), [&](std::uint32_t v) { return touched_[v] != 0; })) return;
    std::size_t longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = f[k];
      const std::uint32_t b = f[(k + 1) % 3];
      if (mesh_.vertices[a] == mesh_.vertices[b]) return join(a, b);
      if (squared_length(mesh_, a, b) > squared_length(mesh_, f[longest], f[(longest + 1) % 3])) longest = k;
    }
    part(face, longest);
  }
  [[nodiscard]] bool any() const { return any_; }
  [[nodiscard]] TriangleMesh outcome() const { return with_faces(mesh_, keep_); }

 private:
  std::vector<std::uint32_t> neighbors_of(std::uint32_t v) const {
    std::vector<std::uint32_t> neighbors;
    for (const std::uint32_t i : around_.of(v))
      for (const std::uint32_t w : mesh_.faces[i])
        if (w != v) neighbors.push_back(w);
    std::sort(neighbors.begin(), neighbors.end());
    neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
    return neighbors;
  }
  bool at_border(std::uint32_t v) const { return around_.of(v).size() != neighbors_of(v).size(); }
  // The face on the left of the edge from a to b.
  std::optional<std::uint32_t> face_of(std::uint32_t a, std::uint32_t b) const {
    for (const std::uint32_t i : around_.of(a))
      for (std::size_t k = 0; k < 3; ++k)
        if (mesh_.faces[i][k] == a && mesh_.faces[i][(k + 1) % 3] == b) return i;
    return std::nullopt;
  }
  bool touches(const std::vector<std::uint32_t>& vertices) const {
    return std::any_of(vertices.begin(), vertices.end(), [&](std::uint32_t v) { return touched_[v] != 0; });
  }
  void touch(const std::vector<std::uint32_t>& vertices) {
    for (const std::uint32_t v : vertices) touched_[v] = 1;
    any_ = true;
  }

  // b becomes a, if the surface stays one: no vertex is next to both but those opposite to their edge, and
  // the edge does not run through the surface from border to border.
  void join(std::uint32_t a, std::uint32_t b) {
    const std::vector<std::uint32_t> of_a = neighbors_of(a);
    const std::vector<std::uint32_t> of_b = neighbors_of(b);
    if (touches(of_a) || touches(of_b)) return;
    std::vector<std::uint32_t> common;
    std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
    const std::size_t faces = (face_of(a, b) ? 1U : 0U) + (face_of(b, a) ? 1U : 0U);
    const bool inner = faces == 2;
    // Of a tetrahedron, or a single face, nothing would be left.
    const std::size_t least_neighbors = inner ? 4 : 3;
    if (common.size() != faces || (inner && at_border(a) && at_border(b)) ||
        std::max(of_a.size(), of_b.size()) < least_neighbors)
      return;
    for (const std::uint32_t i : around_.of(b)) {
      Face& f = mesh_.faces[i];
      if (std::find(f.begin(), f.end(), a) != f.end()) keep_[i] = 0;
      std::replace(f.begin(), f.end(), b, a);
    }
    touch(of_a);
    touch(of_b);
  }

  // The corner opposite to the k-th edge lies on it: it parts the face beyond. At a border there is none, and
  // the face just goes.
  void part(std::uint32_t face, std::size_t k) {
    const Face f = mesh_.faces[face];
    const std::uint32_t from = f[k];
    const std::uint32_t to = f[(k + 1) % 3];
    const std::uint32_t on = f[(k + 2) % 3];
    const std::optional<std::uint32_t> beyond = face_of(to, from);
    if (!beyond) {
      // What lies to its two sides would hang together by a vertex.
      const bool between_two = face_of(on, to) && face_of(from, on);
      if (at_border(on) && between_two) return;
      keep_[face] = 0;
      return touch({from, to, on});
    }
    const Face& g = mesh_.faces[*beyond];
    const std::uint32_t tip =
        *std::find_if(g.begin(), g.end(), [&](std::uint32_t v) { return v != from && v != to; });
    if (touched_[tip] != 0 || face_of(on, tip) || face_of(tip, on)) return;
    const Face first{from, tip, on};
    const Face second{tip, to, on};
    // Of two faces folded onto each other none gains area.
    if (!has_area(mesh_, first) && !has_area(mesh_, second)) return;
    mesh_.faces[face] = first;
    mesh_.faces[*beyond] = second;
    touch({from, to, on, tip});
  }

  TriangleMesh& mesh_;
  VertexFaces around_;
  std::vector<std::uint8_t> touched_;
  std::vector<std::uint8_t> keep_;
  bool any_ = false;
};

}  // namespace

Cleaned without_faces_without_area(const TriangleMesh& mesh) {
  // A strip of many such faces takes a walk for each; one that never ends would not gain.
  constexpr int most_walks = 64;
  std::vector<std::uint32_t> flat = flat_faces(mesh);
  const std::size_t before = flat.size();
  if (before == 0) return {mesh, 0};
  TriangleMesh mended = mesh;
  for (int walks = 0; walks < most_walks && !flat.empty(); ++walks) {
    Walk walk(mended);
    for (const std::uint32_t face : flat) walk.mend(face);
    if (!walk.any()) break;
    mended = walk.outcome();
    flat = flat_faces(mended);
  }
  return {std::move(mended), before - std::min(before, flat.size())};
}

}  // namespace drape::meshing
