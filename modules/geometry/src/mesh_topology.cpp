#include "drape/geometry/mesh_topology.hpp"

#include <algorithm>
#include <array>

#include "drape/base/disjoint_sets.hpp"

namespace drape {
namespace {

// A face's directed edge, sorted by its unordered pair of vertices so that all faces on an edge stand
// together.
struct HalfEdge {
  std::uint32_t low;
  std::uint32_t high;
  std::uint32_t face;
  bool forward;  // the face runs from low to high
};

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.faces.size());
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.faces[i][k];
      const std::uint32_t b = mesh.faces[i][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(i), a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
    return std::array{x.low, x.high, x.face} < std::array{y.low, y.high, y.face};
  });
  return edges;
}

// Calls visit(begin, end) for the half-edges of each edge.
template <class Visit>
void for_each_edge(const std::vector<HalfEdge>& edges, Visit visit) {
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high) ++j;
    visit(i, j);
    i = j;
  }
}

// Reversed edges with one face, sorted: border edges run against their face, so that the hole is on their
// left.
std::vector<std::array<std::uint32_t, 2>> border_of(const std::vector<HalfEdge>& edges) {
  std::vector<std::array<std::uint32_t, 2>> border;
  for_each_edge(edges, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 1) return;
    const HalfEdge& e = edges[begin];
    border.push_back(e.forward ? std::array{e.high, e.low} : std::array{e.low, e.high});
  });
  std::sort(border.begin(), border.end());
  return border;
}

BoundaryLoop from_least_vertex(std::vector<std::uint32_t> vertices, bool closed) {
  if (closed)
    std::rotate(vertices.begin(), std::min_element(vertices.begin(), vertices.end()), vertices.end());
  return {std::move(vertices), closed};
}

std::vector<BoundaryLoop> loops_of(std::size_t vertex_count,
                                   const std::vector<std::array<std::uint32_t, 2>>& border) {
  std::vector<std::uint32_t> next(vertex_count + 1, 0);  // the first unused border edge from each vertex
  for (const auto& edge : border) ++next[edge[0] + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  const std::vector<std::uint32_t> end(next.begin() + 1, next.end());

  constexpr std::uint32_t not_on_path = 0xffffffffU;
  std::vector<std::uint32_t> place(vertex_count, not_on_path);  // on the path walked so far
  std::vector<BoundaryLoop> loops;
  for (std::size_t start = 0; start < border.size(); ++start) {
    std::vector<std::uint32_t> path;
    std::uint32_t v = border[start][0];
    // Walk until every border edge from here is used up; a vertex that comes up again closes a simple loop.
    while (true) {
      if (place[v] != not_on_path) {
        const auto begin = path.begin() + place[v];
        std::vector<std::uint32_t> loop(begin, path.end());
        path.erase(begin, path.end());
        for (const std::uint32_t w : loop) place[w] = not_on_path;
        loops.push_back(from_least_vertex(std::move(loop), true));
      }
      if (next[v] == end[v]) break;
      place[v] = static_cast<std::uint32_t>(path.size());
      path.push_back(v);
      v = border[next[v]++][1];
    }
    if (path.empty()) continue;
    for (const std::uint32_t w : path) place[w] = not_on_path;
    path.push_back(v);
    loops.push_back(from_least_vertex(std::move(path), false));
  }
  std::stable_sort(loops.begin(), loops.end(), [](const BoundaryLoop& a, const BoundaryLoop& b) {
    return a.vertices.front() < b.vertices.front();
  });
  return loops;
}

// The number of sets of border edges that hang together by their vertices.
std::size_t border_count(std::size_t vertex_count, const std::vector<std::array<std::uint32_t, 2>>& border) {
  DisjointSets sets(vertex_count);
  for (const auto& edge : border) sets.join(edge[0], edge[1]);
  std::vector<std::uint32_t> roots;
  for (const auto& edge : border) roots.push_back(sets.find(edge[0]));
  std::sort(roots.begin(), roots.end());
  return static_cast<std::size_t>(std::unique(roots.begin(), roots.end()) - roots.begin());
}

std::vector<std::uint32_t> components_of(const TriangleMesh& mesh, const std::vector<HalfEdge>& edges) {
  DisjointSets sets(mesh.faces.size());
  for_each_edge(edges, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin + 1; i < end; ++i) sets.join(edges[begin].face, edges[i].face);
  });
  std::vector<std::uint32_t> label(mesh.faces.size());
  std::uint32_t count = 0;
  for (std::uint32_t f = 0; f < label.size(); ++f) {
    const std::uint32_t first = sets.find(f);
    label[f] = first == f ? count++ : label[first];
  }
  return label;
}

}  // namespace

std::vector<BoundaryLoop> boundary_loops(const TriangleMesh& mesh) {
  return loops_of(mesh.vertices.size(), border_of(sorted_half_edges(mesh)));
}

std::vector<std::uint32_t> face_components(const TriangleMesh& mesh) {
  return components_of(mesh, sorted_half_edges(mesh));
}

MeshTopology mesh_topology(const TriangleMesh& mesh) {
  const std::vector<HalfEdge> edges = sorted_half_edges(mesh);
  MeshTopology topology;
  for_each_edge(edges, [&](std::size_t begin, std::size_t end) {
    ++topology.edges;
    if (end - begin == 1) ++topology.boundary_edges;
    if (end - begin > 2) ++topology.non_manifold_edges;
    if (end - begin == 2 && edges[begin].forward == edges[begin + 1].forward) ++topology.inconsistent_edges;
  });
  const std::vector<std::uint32_t> components = components_of(mesh, edges);
  if (!components.empty()) topology.components = 1 + *std::max_element(components.begin(), components.end());
  const std::vector<std::array<std::uint32_t, 2>> border = border_of(edges);
  topology.boundary_loops = loops_of(mesh.vertices.size(), border).size();
  topology.borders = border_count(mesh.vertices.size(), border);

  std::vector<std::uint8_t> used(mesh.vertices.size(), 0);
  for (const Face& f : mesh.faces)
    for (const std::uint32_t v : f) used[v] = 1;
  const auto used_count = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
  topology.unused_vertices = used.size() - used_count;
  topology.euler_characteristic = static_cast<std::ptrdiff_t>(used_count) -
                                  static_cast<std::ptrdiff_t>(topology.edges) +
                                  static_cast<std::ptrdiff_t>(mesh.faces.size());
  return topology;
}

}  // namespace drape
