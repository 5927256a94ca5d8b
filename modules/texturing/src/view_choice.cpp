#include "view_choice.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace drape::texturing {
namespace {

constexpr double smoothness =
    0.5;  // what agreeing with all neighbours is worth, in shares of the best quality
constexpr int most_sweeps = 20;
constexpr std::uint32_t nobody = 0xffffffff;

struct Side {
  std::uint32_t neighbor = nobody;
  double share = 0;  // of the face's outline
};

std::vector<std::array<Side, 3>> neighbors_of(const TriangleMesh& mesh) {
  struct Edge {
    std::uint32_t low, high, face, side;
  };
  std::vector<Edge> edges;
  std::vector<std::array<Side, 3>> sides(mesh.faces.size());
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    std::array<double, 3> length{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.faces[f][k];
      const std::uint32_t b = mesh.faces[f][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), f, k});
      length[k] = (mesh.vertices[a] - mesh.vertices[b]).norm();
    }
    const double outline = length[0] + length[1] + length[2];
    for (std::size_t k = 0; k < 3; ++k) sides[f][k].share = outline > 0 ? length[k] / outline : 0;
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return std::array{x.low, x.high, x.face} < std::array{y.low, y.high, y.face};
  });
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const Edge& x = edges[i];
    const Edge& y = edges[i + 1];
    if (x.low != y.low || x.high != y.high) continue;
    sides[x.face][x.side].neighbor = y.face;
    sides[y.face][y.side].neighbor = x.face;
  }
  return sides;
}

}  // namespace

const Candidate& candidate_of(const PaintedFaces& surface, std::size_t face, int view) {
  const auto& set = surface.candidates[surface.candidate_sets[face]];
  const auto at = std::find_if(set.begin(), set.end(), [&](const Candidate& c) { return c.view == view; });
  assert(at != set.end());
  return *at;
}

std::vector<int> chosen_views(const PaintedFaces& surface) {
  std::vector<int> views(surface.mesh.faces.size(), no_view);
  std::vector<double> best(views.size(), 0);
  bool several = false;
  for (std::size_t f = 0; f < views.size(); ++f) {
    for (const Candidate& c : surface.candidates[surface.candidate_sets[f]])
      if (views[f] == no_view || c.quality > best[f]) {
        several = several || views[f] != no_view;
        best[f] = c.quality;
        views[f] = c.view;
      }
    several = several || surface.candidates[surface.candidate_sets[f]].size() > 1;
  }
  if (!several) return views;
  const std::vector<std::array<Side, 3>> sides = neighbors_of(surface.mesh);
  bool changed = true;
  for (int sweep = 0; changed && sweep < most_sweeps; ++sweep) {
    changed = false;
    for (std::size_t f = 0; f < views.size(); ++f) {
      int preferred = views[f];
      double most = -1;
      for (const Candidate& c : surface.candidates[surface.candidate_sets[f]]) {
        double score = best[f] > 0 ? c.quality / best[f] : 0;
        for (const Side& s : sides[f])
          if (s.neighbor != nobody && views[s.neighbor] == c.view) score += smoothness * s.share;
        if (score <= most) continue;
        most = score;
        preferred = c.view;
      }
      changed = changed || preferred != views[f];
      views[f] = preferred;
    }
  }
  return views;
}

}  // namespace drape::texturing
