#include "view_choice.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "drape/base/parallel.hpp"
#include "face_edges.hpp"
#include "tree_reweighted.hpp"

namespace drape::texturing {
namespace {

constexpr std::size_t most_candidates = 8;
constexpr int most_sweeps = 24;
// A pixel of seam costs as much as painting this many square pixels with nothing; where the colours of the
// photos differ, more per unit of log light.
constexpr double seam_px = 2;
constexpr double disagreement_px = 10;

using Labels = std::vector<const Candidate*>;

std::vector<Labels> labels_of(const PaintedFaces& surface) {
  std::vector<Labels> labels(surface.mesh.faces.size());
  for (std::size_t f = 0; f < labels.size(); ++f) {
    for (const Candidate& c : surface.candidates[surface.candidate_sets[f]]) labels[f].push_back(&c);
    std::stable_sort(labels[f].begin(), labels[f].end(),
                     [](const Candidate* a, const Candidate* b) { return a->quality > b->quality; });
    if (labels[f].size() > most_candidates) labels[f].resize(most_candidates);
  }
  return labels;
}

// Pixels per unit length where the surface is seen best, typically.
double typical_resolution(const std::vector<Labels>& labels) {
  std::vector<double> best;
  for (const Labels& l : labels)
    if (!l.empty()) best.push_back(std::sqrt(l.front()->quality));
  if (best.empty()) return 1;
  const auto middle = best.begin() + static_cast<std::ptrdiff_t>(best.size() / 2);
  std::nth_element(best.begin(), middle, best.end());
  return *middle;
}

double seam_cost(const Candidate& a, const Labels& of_a, const Candidate& b, const Labels& of_b) {
  if (a.view == b.view) return 0;
  double difference = 0;
  double known = 0;
  const auto compare = [&](const Candidate& own, int other_view, const Labels& labels) {
    for (const Candidate* c : labels)
      if (c->view == other_view) {
        difference += (c->log_color - own.log_color).cwiseAbs().mean();
        known += 1;
      }
  };
  compare(a, b.view, of_a);
  compare(b, a.view, of_b);
  constexpr double of_the_unknown = 0.3;  // a seam where one photo sees only one side
  return seam_px + disagreement_px * (known > 0 ? difference / known : of_the_unknown);
}

LabelProblem problem_of(const TriangleMesh& mesh, const std::vector<Labels>& labels) {
  LabelProblem problem;
  const double resolution = typical_resolution(labels);
  for (std::size_t f = 0; f < labels.size(); ++f) {
    const double area_px = scaled_face_normal(mesh, f).norm() / 2 * resolution * resolution;
    for (const Candidate* c : labels[f])
      problem.unary.push_back(
          static_cast<float>(area_px * (1 - c->quality / std::max(labels[f].front()->quality, 1e-300))));
    problem.first_label.push_back(static_cast<std::uint32_t>(problem.unary.size()));
  }
  for (const FaceEdge& e : face_edges(mesh)) {
    const Labels& first = labels[e.first];
    const Labels& second = labels[e.second];
    if (first.empty() || second.empty()) continue;
    const double length_px = (mesh.vertices[e.low] - mesh.vertices[e.high]).norm() * resolution;
    problem.edges.push_back({e.first, e.second, static_cast<std::uint32_t>(problem.pairwise.size())});
    for (const Candidate* a : first)
      for (const Candidate* b : second)
        problem.pairwise.push_back(static_cast<float>(length_px * seam_cost(*a, first, *b, second)));
  }
  return problem;
}

}  // namespace

const Candidate& candidate_of(const PaintedFaces& surface, std::size_t face, int view) {
  const auto& set = surface.candidates[surface.candidate_sets[face]];
  const auto at = std::find_if(set.begin(), set.end(), [&](const Candidate& c) { return c.view == view; });
  assert(at != set.end());
  return *at;
}

std::vector<int> chosen_views(const PaintedFaces& surface) {
  const std::vector<Labels> labels = labels_of(surface);
  std::vector<int> views(labels.size(), no_view);
  const bool several =
      std::any_of(labels.begin(), labels.end(), [](const Labels& l) { return l.size() > 1; });
  std::vector<std::uint32_t> chosen(labels.size(), 0);
  if (several) chosen = least_cost_labels(problem_of(surface.mesh, labels), most_sweeps).labels;
  for (std::size_t f = 0; f < labels.size(); ++f)
    if (!labels[f].empty()) views[f] = labels[f][chosen[f]]->view;
  return views;
}

void drop_hidden(const PaintedFaces& surface, std::span<const PhotoSight> sights, std::vector<int>& chosen) {
  const TriangleMesh& mesh = surface.mesh;
  parallel_for(chosen.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      if (chosen[f] == no_view) continue;
      const PhotoSight& sight = sights[static_cast<std::size_t>(chosen[f])];
      const Face& face = mesh.faces[f];
      const Eigen::Vector3d middle =
          (mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) / 3;
      const double cosine =
          scaled_face_normal(mesh, f).stableNormalized().dot(sight.camera().towards_camera(middle));
      if (sight.blocked(middle, std::max(cosine, 1e-3))) chosen[f] = no_view;
    }
  });
}

}  // namespace drape::texturing
