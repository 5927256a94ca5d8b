#include "orientation.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace drape::meshing {
namespace {

constexpr std::uint32_t none = 0xffffffffU;

struct HalfEdge {
  std::uint32_t low, high, face, corner;
  bool forward;
};

// What lies across each edge of each face.
struct Adjacency {
  std::vector<std::array<std::uint32_t, 3>> neighbor;
  std::vector<std::array<bool, 3>> agrees;  // whether the two faces run along the edge in opposite directions
};

Adjacency adjacency_of(const TriangleMesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.faces.size());
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.faces[i][k];
      const std::uint32_t b = mesh.faces[i][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), i, k, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::array{a.low, a.high, a.face} < std::array{b.low, b.high, b.face};
  });
  Adjacency adjacency;
  adjacency.neighbor.assign(mesh.faces.size(), {none, none, none});
  adjacency.agrees.assign(mesh.faces.size(), {true, true, true});
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const HalfEdge& a = edges[i - 1];
    const HalfEdge& b = edges[i];
    if (a.low != b.low || a.high != b.high) continue;
    adjacency.neighbor[a.face][a.corner] = b.face;
    adjacency.neighbor[b.face][b.corner] = a.face;
    adjacency.agrees[a.face][a.corner] = adjacency.agrees[b.face][b.corner] = a.forward != b.forward;
  }
  return adjacency;
}

}  // namespace

TriangleMesh in_canonical_order(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto coordinates = [&](std::uint32_t v) {
    const Eigen::Vector3d& p = mesh.vertices[v];
    return std::array{p.x(), p.y(), p.z()};
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return coordinates(a) < coordinates(b); });
  TriangleMesh ordered;
  std::vector<std::uint32_t> place(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    place[order[i]] = i;
    ordered.vertices.push_back(mesh.vertices[order[i]]);
  }
  for (const Face& f : mesh.faces) {
    ordered.faces.push_back({place[f[0]], place[f[1]], place[f[2]]});
    std::sort(ordered.faces.back().begin(), ordered.faces.back().end());
  }
  std::sort(ordered.faces.begin(), ordered.faces.end());
  return ordered;
}

TriangleMesh oriented_by_votes(const TriangleMesh& mesh, const std::vector<double>& votes) {
  const Adjacency adjacency = adjacency_of(mesh);
  enum State : std::uint8_t { unseen, kept, turned, dropped };
  std::vector<std::uint8_t> state(mesh.faces.size(), unseen);
  std::vector<std::uint32_t> piece;
  for (std::uint32_t seed = 0; seed < mesh.faces.size(); ++seed) {
    if (state[seed] != unseen) continue;
    piece.assign(1, seed);
    state[seed] = kept;
    double sum = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::uint32_t face = piece[i];
      if (state[face] == dropped) continue;
      sum += state[face] == kept ? votes[face] : -votes[face];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = adjacency.neighbor[face][k];
        if (next == none || state[next] == dropped) continue;
        const std::uint8_t wanted = (state[face] == kept) == adjacency.agrees[face][k] ? kept : turned;
        if (state[next] == unseen) {
          state[next] = wanted;
          piece.push_back(next);
        } else if (state[next] != wanted) {
          state[next] = dropped;
        }
      }
    }
    if (sum < 0)
      for (const std::uint32_t face : piece)
        if (state[face] != dropped) state[face] = state[face] == kept ? turned : kept;
  }
  TriangleMesh result = mesh;
  for (std::size_t i = 0; i < state.size(); ++i)
    if (state[i] == turned) std::swap(result.faces[i][1], result.faces[i][2]);
  if (std::find(state.begin(), state.end(), dropped) == state.end()) return result;
  std::vector<std::uint8_t> keep(state.size());
  for (std::size_t i = 0; i < keep.size(); ++i) keep[i] = state[i] == dropped ? 0 : 1;
  return with_faces(result, keep);
}

}  // namespace drape::meshing
