#include "seam_levelling.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>

#include "drape/base/parallel.hpp"
#include "view_choice.hpp"

namespace drape::texturing {
namespace {

constexpr double smoothness = 0.3;  // of a correction along an edge, against agreement at a vertex
constexpr double anchor = 1e-4;     // keeps the mean where it was
constexpr double plain = 0.05;      // contrast, of log light, from which on agreement counts less

constexpr double excessive = 4;        // times the typical step between photos
constexpr double least_excess = 0.15;  // of log light

using Sparse = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

// The unknowns: number of the first of each vertex.
struct Unknowns {
  std::vector<int> first;
  [[nodiscard]] int at(std::size_t vertex, const VertexGains& gains, int view) const {
    for (std::size_t i = 0; i < gains.size(); ++i)
      if (gains[i].view == view) return first[vertex] + static_cast<int>(i);
    return -1;
  }
};

void add_difference(Triplets& normal, int a, int b, double weight) {
  normal.emplace_back(a, a, weight);
  normal.emplace_back(b, b, weight);
  // The lower half is enough.
  normal.emplace_back(std::max(a, b), std::min(a, b), -weight);
}

void add_smoothness(Triplets& normal, const TriangleMesh& mesh, std::span<const int> chosen,
                    const std::vector<VertexGains>& gains, const Unknowns& unknowns) {
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    if (chosen[f] == no_view) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.faces[f][k];
      const std::uint32_t b = mesh.faces[f][(k + 1) % 3];
      for (const ViewGain& g : gains[a]) {
        const int other = unknowns.at(b, gains[b], g.view);
        // Each edge comes up once from either side.
        if (other >= 0) add_difference(normal, unknowns.at(a, gains[a], g.view), other, smoothness / 2);
      }
    }
  }
}

// The exposures that corrections start from leave little to do: a few steps of conjugate gradients from zero.
Eigen::MatrixXd solved_from_zero(const Sparse& lower, const Eigen::MatrixXd& right) {
  constexpr double close_enough = 2e-3;  // of the right side
  constexpr int most_steps = 300;
  const Sparse matrix = lower.selfadjointView<Eigen::Lower>();
  Eigen::MatrixXd solved(right.rows(), right.cols());
  parallel_for(static_cast<std::size_t>(right.cols()), 1, [&](std::size_t begin, std::size_t end) {
    for (auto c = static_cast<Eigen::Index>(begin); c < static_cast<Eigen::Index>(end); ++c) {
      Eigen::ConjugateGradient<Sparse, Eigen::Lower | Eigen::Upper> solver;
      solver.setTolerance(close_enough);
      solver.setMaxIterations(most_steps);
      solved.col(c) = solver.compute(matrix).solve(right.col(c));
    }
  });
  return solved;
}

// Two photos at one vertex: what the second one's log colour is more than the first one's.
struct Step {
  int a;
  int b;
  double weight;
  Eigen::Vector3d difference;
};

std::vector<Step> steps_between_photos(const PaintedFaces& surface, std::span<const VertexGains> gains,
                                       const Unknowns& unknowns, std::span<const PhotoSight> sights,
                                       std::span<const PhotoColors> colors) {
  std::vector<Step> steps;
  for (std::size_t v = 0; v < gains.size(); ++v) {
    if (gains[v].size() < 2) continue;
    std::vector<Eigen::Vector3d> seen;
    std::vector<double> contrast;
    for (const ViewGain& g : gains[v]) {
      const auto view = static_cast<std::size_t>(g.view);
      const Eigen::Vector2d pixel = sights[view].pixel_of(surface.mesh.vertices[v]);
      seen.emplace_back((log_light(colors[view].smooth_at(pixel)) + g.gain).cast<double>());
      contrast.push_back(colors[view].contrast_at(pixel));
    }
    for (std::size_t i = 0; i < seen.size(); ++i)
      for (std::size_t j = i + 1; j < seen.size(); ++j) {
        // Near edges, photos differ by what each resolves rather than by their light.
        const double weight =
            1 / (1 + (contrast[i] * contrast[i] + contrast[j] * contrast[j]) / (plain * plain));
        steps.push_back({unknowns.first[v] + static_cast<int>(i), unknowns.first[v] + static_cast<int>(j),
                         weight, seen[j] - seen[i]});
      }
  }
  return steps;
}

double typical_size(const std::vector<Step>& steps) {
  if (steps.empty()) return 0;
  std::vector<double> sizes;
  for (const Step& step : steps) sizes.push_back(step.difference.norm());
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

}  // namespace

std::vector<VertexGains> no_gains(const PaintedFaces& surface, std::span<const int> chosen,
                                  std::span<const VertexBlend> blends) {
  std::vector<VertexGains> gains(blends.size());
  for (std::size_t v = 0; v < blends.size(); ++v)
    for (const ViewWeight& w : blends[v]) gains[v].push_back({w.view, Eigen::Vector3f::Zero()});
  for (std::size_t f = 0; f < chosen.size(); ++f) {
    if (chosen[f] == no_view) continue;
    for (const std::uint32_t v : surface.mesh.faces[f]) {
      if (!blends[v].empty()) continue;
      const bool known = std::any_of(gains[v].begin(), gains[v].end(),
                                     [&](const ViewGain& g) { return g.view == chosen[f]; });
      if (!known) gains[v].push_back({chosen[f], Eigen::Vector3f::Zero()});
    }
  }
  return gains;
}

std::vector<VertexGains> levelling_gains(const PaintedFaces& surface, std::span<const int> chosen,
                                         std::span<const VertexBlend> blends,
                                         std::span<const PhotoSight> sights,
                                         std::span<const PhotoColors> colors,
                                         std::span<const Eigen::Vector3f> exposures) {
  std::vector<VertexGains> gains = no_gains(surface, chosen, blends);
  Unknowns unknowns;
  int count = 0;
  bool several = false;
  for (VertexGains& at_vertex : gains) {
    for (ViewGain& g : at_vertex) g.gain = exposures[static_cast<std::size_t>(g.view)];
    unknowns.first.push_back(count);
    count += static_cast<int>(at_vertex.size());
    several = several || at_vertex.size() > 1;
  }
  if (!several) return gains;

  const std::vector<Step> steps = steps_between_photos(surface, gains, unknowns, sights, colors);
  const double typical = typical_size(steps);
  Triplets normal;
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, 3);
  for (int i = 0; i < count; ++i) normal.emplace_back(i, i, anchor);
  for (const Step& step : steps) {
    // Geman and McClure: steps much larger than most are of other paint, a little beside.
    const double excess = step.difference.norm() / std::max(least_excess, excessive * typical);
    const double trust = 1 / (1 + excess * excess);
    const double weight = step.weight * trust * trust;
    add_difference(normal, step.a, step.b, weight);
    right.row(step.a) += weight * step.difference.transpose();
    right.row(step.b) -= weight * step.difference.transpose();
  }
  add_smoothness(normal, surface.mesh, chosen, gains, unknowns);
  Sparse matrix(count, count);
  matrix.setFromTriplets(normal.begin(), normal.end());
  const Eigen::MatrixXd solved = solved_from_zero(matrix, right);
  for (std::size_t v = 0; v < gains.size(); ++v)
    for (std::size_t i = 0; i < gains[v].size(); ++i)
      gains[v][i].gain += solved.row(unknowns.first[v] + static_cast<int>(i)).transpose().cast<float>();
  return gains;
}

}  // namespace drape::texturing
