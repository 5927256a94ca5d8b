#include "cleaning.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "drape/geometry/mesh_topology.hpp"

namespace drape::meshing {
namespace {

std::array<double, 3> coordinates(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

// For each face, how many of its edges have no other face.
std::vector<std::uint8_t> border_edge_counts(const TriangleMesh& mesh) {
  struct Edge {
    std::uint32_t low, high, face;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.faces.size());
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.faces[i][k], mesh.faces[i][(k + 1) % 3]);
      edges.push_back({low, high, i});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::array{a.low, a.high, a.face} < std::array{b.low, b.high, b.face};
  });
  std::vector<std::uint8_t> counts(mesh.faces.size(), 0);
  const auto same = [](const Edge& a, const Edge& b) { return a.low == b.low && a.high == b.high; };
  for (std::size_t i = 0; i < edges.size(); ++i)
    if ((i == 0 || !same(edges[i - 1], edges[i])) && (i + 1 == edges.size() || !same(edges[i], edges[i + 1])))
      ++counts[edges[i].face];
  return counts;
}

}  // namespace

Cleaned without_bad_faces(const TriangleMesh& mesh) {
  std::vector<std::uint8_t> keep(mesh.faces.size(), 1);
  std::vector<Face> sorted = mesh.faces;
  for (Face& f : sorted) std::sort(f.begin(), f.end());
  std::vector<std::uint32_t> order(mesh.faces.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return sorted[a] < sorted[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Face& f = sorted[order[i]];
    const bool repeated = i > 0 && f == sorted[order[i - 1]];
    if (f[0] == f[1] || f[1] == f[2] || repeated) keep[order[i]] = 0;
  }
  const auto removed = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), 0));
  return {removed == 0 ? mesh : with_faces(mesh, keep), removed};
}

Cleaned without_flat_pockets(const TriangleMesh& mesh) {
  // By their sorted vertices, with the parity of the sorting.
  struct Turned {
    Face sorted;
    bool odd;
    std::uint32_t face;
  };
  std::vector<Turned> faces;
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i) {
    Face f = mesh.faces[i];
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    const bool odd = f[1] > f[2];
    if (odd) std::swap(f[1], f[2]);
    faces.push_back({f, odd, i});
  }
  std::sort(faces.begin(), faces.end(), [](const Turned& a, const Turned& b) {
    return a.sorted != b.sorted ? a.sorted < b.sorted : a.face < b.face;
  });
  std::vector<std::uint8_t> keep(mesh.faces.size(), 1);
  for (std::size_t i = 0; i + 1 < faces.size(); ++i)
    if (faces[i].sorted == faces[i + 1].sorted && faces[i].odd != faces[i + 1].odd) {
      keep[faces[i].face] = keep[faces[i + 1].face] = 0;
      ++i;
    }
  const auto removed = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), 0));
  return {removed == 0 ? mesh : with_faces(mesh, keep), removed};
}

Cleaned without_small_components(const TriangleMesh& mesh, double percent) {
  const std::vector<std::uint32_t> component = face_components(mesh);
  if (component.empty()) return {mesh, 0};
  std::vector<std::size_t> sizes(1 + *std::max_element(component.begin(), component.end()), 0);
  for (const std::uint32_t c : component) ++sizes[c];
  const double least = percent / 100 * static_cast<double>(mesh.faces.size());
  const std::size_t largest = *std::max_element(sizes.begin(), sizes.end());
  const auto stays = [&](std::size_t size) { return size == largest || static_cast<double>(size) >= least; };
  const auto removed =
      sizes.size() - static_cast<std::size_t>(std::count_if(sizes.begin(), sizes.end(), stays));
  if (removed == 0) return {mesh, 0};
  std::vector<std::uint8_t> keep(mesh.faces.size());
  for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = stays(sizes[component[i]]) ? 1 : 0;
  return {with_faces(mesh, keep), removed};
}

Cleaned without_border_teeth(const TriangleMesh& mesh, int rounds) {
  Cleaned cleaned{mesh, 0};
  for (int round = 0; round < rounds; ++round) {
    const std::vector<std::uint8_t> border_edges = border_edge_counts(cleaned.mesh);
    std::vector<std::uint8_t> keep(border_edges.size());
    for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = border_edges[i] < 2 ? 1 : 0;
    const auto removed = static_cast<std::size_t>(std::count(keep.begin(), keep.end(), 0));
    // A mesh of teeth alone is all there is of a surface: it stays.
    if (removed == 0 || removed == keep.size()) break;
    cleaned = {with_faces(cleaned.mesh, keep), cleaned.removed + removed};
  }
  return cleaned;
}

Cleaned with_joined_borders(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> border;
  for (const BoundaryLoop& loop : boundary_loops(mesh))
    border.insert(border.end(), loop.vertices.begin(), loop.vertices.end());
  std::sort(border.begin(), border.end());
  border.erase(std::unique(border.begin(), border.end()), border.end());
  std::stable_sort(border.begin(), border.end(), [&](std::uint32_t a, std::uint32_t b) {
    return coordinates(mesh.vertices[a]) < coordinates(mesh.vertices[b]);
  });
  std::vector<std::uint32_t> renamed(mesh.vertices.size());
  std::iota(renamed.begin(), renamed.end(), 0U);
  std::size_t joined = 0;
  for (std::size_t i = 1; i < border.size(); ++i)
    if (mesh.vertices[border[i]] == mesh.vertices[border[i - 1]]) {
      renamed[border[i]] = renamed[border[i - 1]];
      ++joined;
    }
  if (joined == 0) return {mesh, 0};
  TriangleMesh result = mesh;
  for (Face& f : result.faces)
    for (std::uint32_t& v : f) v = renamed[v];
  return {without_unused_vertices(result), joined};
}

}  // namespace drape::meshing
