#include "blend_weights.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"
#include "view_choice.hpp"

namespace drape::texturing {
namespace {

constexpr std::size_t vertices_per_chunk = 1024;
constexpr int most_steps = 60;
constexpr float least_weight = 1e-3F;
// From this share of the best photo's quality on a photo may mix, and from that one on it counts in full.
constexpr double least_quality = 0.5;
constexpr double full_quality = 0.9;

float* weight_of(VertexBlend& blend, int view) {
  for (ViewWeight& w : blend)
    if (w.view == view) return &w.weight;
  return nullptr;
}

float weight_in(const VertexBlend& blend, int view) {
  for (const ViewWeight& w : blend)
    if (w.view == view) return w.weight;
  return 0;
}

void normalize(VertexBlend& blend) {
  float sum = 0;
  for (const ViewWeight& w : blend) sum += w.weight;
  if (!(sum > 0)) {
    blend.clear();
    return;
  }
  for (ViewWeight& w : blend) w.weight /= sum;
}

float suitability(double quality, double best) {
  const double t = std::clamp((quality / best - least_quality) / (full_quality - least_quality), 0.0, 1.0);
  return static_cast<float>(t * t * (3 - 2 * t));
}

// Per vertex the views that see all painted faces round it, weighted by the worst of how well.
std::vector<VertexBlend> common_views(const PaintedFaces& surface, std::span<const int> chosen) {
  std::vector<VertexBlend> common(surface.mesh.vertices.size());
  std::vector<std::uint8_t> met(common.size(), 0);
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    if (chosen[f] == no_view) continue;
    const auto& set = surface.candidates[surface.candidate_sets[f]];
    double best = 0;
    for (const Candidate& c : set) best = std::max(best, c.quality);
    VertexBlend here;
    for (const Candidate& c : set) {
      // What the face was given is good enough for it.
      const float suits = c.view == chosen[f] ? 1.F : suitability(c.quality, best);
      if (suits > 0) here.push_back({c.view, suits});
    }
    for (const std::uint32_t v : surface.mesh.faces[f]) {
      if (met[v] == 0) {
        met[v] = 1;
        common[v] = here;
        continue;
      }
      for (ViewWeight& w : common[v]) w.weight = std::min(w.weight, weight_in(here, w.view));
      std::erase_if(common[v], [](const ViewWeight& w) { return w.weight <= 0; });
    }
  }
  for (VertexBlend& blend : common)
    std::sort(blend.begin(), blend.end(),
              [](const ViewWeight& a, const ViewWeight& b) { return a.view < b.view; });
  return common;
}

struct Neighbors {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> list;
};

Neighbors painted_neighbors(const TriangleMesh& mesh, std::span<const int> chosen) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    if (chosen[f] == no_view) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      pairs.emplace_back(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]);
      pairs.emplace_back(mesh.faces[f][(k + 1) % 3], mesh.faces[f][k]);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  Neighbors neighbors;
  neighbors.first.assign(mesh.vertices.size() + 1, 0);
  for (const auto& [a, b] : pairs) {
    ++neighbors.first[a + 1];
    neighbors.list.push_back(b);
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) neighbors.first[v + 1] += neighbors.first[v];
  return neighbors;
}

// Each vertex takes half of the mean of its neighbours, of the views that it may have.
std::vector<VertexBlend> diffused(const std::vector<VertexBlend>& blends,
                                  const std::vector<VertexBlend>& common, const Neighbors& neighbors) {
  std::vector<VertexBlend> next(blends.size());
  parallel_for(blends.size(), vertices_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (blends[v].empty()) continue;
      next[v] = common[v];
      for (ViewWeight& w : next[v]) {
        const std::uint32_t from = neighbors.first[v];
        const std::uint32_t to = neighbors.first[v + 1];
        float sum = 0;
        for (std::uint32_t i = from; i < to; ++i) sum += weight_in(blends[neighbors.list[i]], w.view);
        w.weight = weight_in(blends[v], w.view) + sum / static_cast<float>(std::max(1U, to - from));
      }
      std::erase_if(next[v], [](const ViewWeight& w) { return w.weight < least_weight; });
      normalize(next[v]);
    }
  });
  return next;
}

double typical_edge_px(const PaintedFaces& surface, std::span<const int> chosen) {
  std::vector<double> lengths;
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    if (chosen[f] == no_view) continue;
    const double quality = candidate_of(surface, f, chosen[f]).quality;
    lengths.push_back(std::sqrt(scaled_face_normal(surface.mesh, f).norm() * quality));
  }
  if (lengths.empty()) return 1;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return std::max(0.1, *middle);
}

}  // namespace

std::vector<VertexBlend> blend_weights(const PaintedFaces& surface, std::span<const int> chosen,
                                       double blend_px) {
  const std::vector<VertexBlend> common = common_views(surface, chosen);
  std::vector<VertexBlend> blends(common.size());
  for (std::size_t v = 0; v < blends.size(); ++v) {
    blends[v] = common[v];
    for (ViewWeight& w : blends[v]) w.weight = 0;
  }
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    if (chosen[f] == no_view) continue;
    const auto area = static_cast<float>(scaled_face_normal(surface.mesh, f).norm());
    for (const std::uint32_t v : surface.mesh.faces[f])
      if (float* weight = weight_of(blends[v], chosen[f])) *weight += area;
  }
  for (std::size_t v = 0; v < blends.size(); ++v) {
    // None of the photos chosen round it sees all of it, but another does.
    if (!blends[v].empty() &&
        std::all_of(blends[v].begin(), blends[v].end(), [](const ViewWeight& w) { return w.weight <= 0; }))
      blends[v] = common[v];
    normalize(blends[v]);
  }
  // A random walk of n half-lazy steps spreads by the root of n / 2 edges.
  const double edges = blend_px / typical_edge_px(surface, chosen);
  const int steps = std::min(most_steps, static_cast<int>(std::lround(2 * edges * edges)));
  const Neighbors neighbors = painted_neighbors(surface.mesh, chosen);
  for (int i = 0; i < steps; ++i) blends = diffused(blends, common, neighbors);
  for (std::size_t v = 0; v < blends.size(); ++v) {
    for (ViewWeight& w : blends[v]) w.weight *= weight_in(common[v], w.view);
    normalize(blends[v]);
  }
  return blends;
}

}  // namespace drape::texturing
