#include "boundary.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace drape::meshing {
namespace {

using HalfEdge = std::array<std::uint32_t, 2>;

// Reversed face edges that no face runs along, by their first vertex.
std::vector<HalfEdge> border_half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.faces.size());
  for (const Face& f : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({f[k], f[(k + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  std::vector<HalfEdge> border;
  for (const HalfEdge& e : edges)
    if (const HalfEdge opposite{e[1], e[0]}; !std::binary_search(edges.begin(), edges.end(), opposite))
      border.push_back(opposite);
  std::sort(border.begin(), border.end());
  return border;
}

SimpleLoop from_least_vertex(std::vector<std::uint32_t> vertices, bool closed) {
  if (closed)
    std::rotate(vertices.begin(), std::min_element(vertices.begin(), vertices.end()), vertices.end());
  return {std::move(vertices), closed};
}

}  // namespace

std::vector<SimpleLoop> simple_border_loops(const TriangleMesh& mesh) {
  const std::vector<HalfEdge> border = border_half_edges(mesh);
  std::vector<std::uint32_t> next(mesh.vertices.size() + 1, 0);  // the first unused half-edge of each vertex
  for (const HalfEdge& e : border) ++next[e[0] + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  const std::vector<std::uint32_t> end(next.begin() + 1, next.end());

  constexpr std::uint32_t not_on_path = 0xffffffffU;
  std::vector<std::uint32_t> place(mesh.vertices.size(), not_on_path);  // on the path walked so far
  std::vector<SimpleLoop> loops;
  for (std::size_t start = 0; start < border.size(); ++start) {
    std::vector<std::uint32_t> path;
    std::uint32_t v = border[start][0];
    // Walk until every border from here is used up; a vertex that comes up again closes a simple loop.
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
  std::stable_sort(loops.begin(), loops.end(), [](const SimpleLoop& a, const SimpleLoop& b) {
    return a.vertices.front() < b.vertices.front();
  });
  return loops;
}

}  // namespace drape::meshing
