#include "spot_mending.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "cleaning.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "patching.hpp"
#include "vertex_fans.hpp"

namespace drape::meshing {
namespace {

// Per face, 1 where it lies on an edge with more than two faces, or with two that run along it alike.
std::vector<std::uint8_t> faces_on_wrong_edges(const TriangleMesh& mesh) {
  struct HalfEdge {
    std::uint32_t low, high;
    bool forward;
    std::uint32_t face;
  };
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.faces.size());
  for (std::uint32_t i = 0; i < mesh.faces.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.faces[i][k];
      const std::uint32_t b = mesh.faces[i][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b, i});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::array{a.low, a.high, a.face} < std::array{b.low, b.high, b.face};
  });
  std::vector<std::uint8_t> wrong(mesh.faces.size(), 0);
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high)
      ++end;
    if (end - begin > 2 || (end - begin == 2 && edges[begin].forward == edges[begin + 1].forward))
      for (std::size_t i = begin; i < end; ++i) wrong[edges[i].face] = 1;
    begin = end;
  }
  return wrong;
}

// Vertices keep their numbers.
TriangleMesh without_marked(const TriangleMesh& mesh, const std::vector<std::uint8_t>& marked) {
  TriangleMesh cut = mesh;
  cut.faces.clear();
  cut.filled.clear();
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    if (marked[i] == 0) cut.faces.push_back(mesh.faces[i]);
  return cut;
}

// The borders that run along nothing but vertices of the cut-out faces.
std::vector<LoopToFill> cut_loops(const TriangleMesh& mesh, const TriangleMesh& cut,
                                  const std::vector<std::uint8_t>& marked) {
  std::vector<std::uint8_t> touched(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    if (marked[i] != 0)
      for (const std::uint32_t v : mesh.faces[i]) touched[v] = 1;
  std::vector<LoopToFill> loops;
  for (BoundaryLoop& loop : boundary_loops(cut))
    if (loop.closed && std::all_of(loop.vertices.begin(), loop.vertices.end(),
                                   [&](std::uint32_t v) { return touched[v] != 0; }))
      loops.push_back({std::move(loop.vertices), PatchStyle::plain});
  return loops;
}

// The faces of the pairs, and `rings` of faces round them.
std::vector<std::uint8_t> round_pairs(const TriangleMesh& mesh, const std::vector<FacePair>& pairs,
                                      int rings) {
  std::vector<std::uint8_t> marked(mesh.faces.size(), 0);
  for (const auto& [a, b] : pairs) marked[a] = marked[b] = 1;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::uint8_t> touched(mesh.vertices.size(), 0);
    for (std::size_t i = 0; i < marked.size(); ++i)
      if (marked[i] != 0)
        for (const std::uint32_t v : mesh.faces[i]) touched[v] = 1;
    for (std::size_t i = 0; i < marked.size(); ++i) {
      const Face& f = mesh.faces[i];
      if (touched[f[0]] != 0 || touched[f[1]] != 0 || touched[f[2]] != 0) marked[i] = 1;
    }
  }
  return marked;
}

}  // namespace

TriangleMesh with_spots_mended(const TriangleMesh& mesh) {
  constexpr int rounds = 8;  // each takes more round what the one before could not mend; two do as a rule
  TriangleMesh mended = mesh;
  for (int round = 0; round < rounds; ++round) {
    mended = without_bad_faces(without_flat_pockets(mended).mesh).mesh;
    const std::vector<std::uint8_t> wrong = faces_on_wrong_edges(mended);
    if (std::find(wrong.begin(), wrong.end(), 1) == wrong.end()) break;
    const TriangleMesh cut = without_marked(mended, wrong);
    // The last cuts stay open: better a hole than a wrong edge.
    mended = round + 1 == rounds ? cut
                                 : with_patches(cut, cut_loops(mended, cut, wrong), nullptr, Progress()).mesh;
  }
  return without_unused_vertices(with_parted_fans(mended).mesh);
}

Uncrossed with_crossings_mended(const TriangleMesh& mesh) {
  std::vector<FacePair> pairs = self_intersecting_pairs(mesh);
  Uncrossed result{mesh, pairs.size(), pairs.size()};
  constexpr int rounds = 3;  // each cuts a ring more round what is left
  for (int round = 0; round < rounds && !pairs.empty(); ++round) {
    const std::vector<std::uint8_t> marked = round_pairs(result.mesh, pairs, round + 1);
    const TriangleMesh cut = without_marked(result.mesh, marked);
    TriangleMesh mended = with_patches(cut, cut_loops(result.mesh, cut, marked), nullptr, Progress()).mesh;
    mended.filled.clear();
    mended = without_touching_fans(mended).mesh;
    std::vector<FacePair> left = self_intersecting_pairs(mended);
    if (left.size() >= pairs.size()) continue;
    pairs = std::move(left);
    result.mesh = without_unused_vertices(mended);
    result.left = pairs.size();
  }
  return result;
}

}  // namespace drape::meshing
