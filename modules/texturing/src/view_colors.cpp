#include "view_colors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "drape/base/parallel.hpp"

namespace drape::texturing {
namespace {

constexpr std::size_t faces_per_chunk = 512;

float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector3f median_color(const std::vector<Candidate>& set) {
  Eigen::Vector3f result;
  std::vector<float> values(set.size());
  for (int c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < set.size(); ++i) values[i] = set[i].log_color[c];
    std::sort(values.begin(), values.end());
    result[c] = (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2;
  }
  return result;
}

}  // namespace

void look_up_colors(PaintedFaces& surface, std::span<const PhotoSight> sights,
                    std::span<const PhotoColors> colors) {
  const TriangleMesh& mesh = surface.mesh;
  parallel_for(mesh.faces.size(), faces_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Face& face = mesh.faces[f];
      const Eigen::Vector3d middle =
          (mesh.vertices[face[0]] + mesh.vertices[face[1]] + mesh.vertices[face[2]]) / 3;
      for (Candidate& c : surface.candidates[surface.candidate_sets[f]]) {
        const auto v = static_cast<std::size_t>(c.view);
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (const std::uint32_t corner : face)
          sum += colors[v].at(sights[v].pixel_of((middle + mesh.vertices[corner]) / 2));
        c.log_color = log_light((sum + colors[v].at(sights[v].pixel_of(middle))) / 4);
      }
    }
  });
}

std::vector<Eigen::Vector3f> matched_exposures(const PaintedFaces& surface, std::size_t views) {
  std::vector<std::vector<Eigen::Vector3f>> differences(views * views);
  for (const auto& set : surface.candidates)
    for (std::size_t i = 0; i < set.size(); ++i)
      for (std::size_t j = i + 1; j < set.size(); ++j)
        if (set[i].full_share > 0.5 && set[j].full_share > 0.5)
          differences[static_cast<std::size_t>(set[i].view) * views + static_cast<std::size_t>(set[j].view)]
              .push_back(set[j].log_color - set[i].log_color);
  const auto n = static_cast<Eigen::Index>(views);
  Eigen::MatrixXd normal = 1e-6 * Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, 3);
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b) {
      const auto& pairs = differences[static_cast<std::size_t>(a * n + b)];
      constexpr std::size_t least_faces = 20;
      if (pairs.size() < least_faces) continue;
      const double weight = std::sqrt(static_cast<double>(pairs.size()));
      normal(a, a) += weight;
      normal(b, b) += weight;
      normal(a, b) -= weight;
      normal(b, a) -= weight;
      std::vector<float> channel(pairs.size());
      for (int c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < pairs.size(); ++i) channel[i] = pairs[i][c];
        const double step = median(channel);
        right(a, c) += weight * step;
        right(b, c) -= weight * step;
      }
    }
  const Eigen::MatrixXd solved = normal.ldlt().solve(right);
  std::vector<Eigen::Vector3f> exposures;
  for (Eigen::Index v = 0; v < n; ++v) exposures.emplace_back(solved.row(v).transpose().cast<float>());
  return exposures;
}

void apply_exposures(PaintedFaces& surface, std::span<const Eigen::Vector3f> exposures) {
  for (auto& set : surface.candidates)
    for (Candidate& c : set) c.log_color += exposures[static_cast<std::size_t>(c.view)];
}

std::size_t drop_outliers(PaintedFaces& surface) {
  constexpr float least_deviation = 0.25F;  // of log light; never dropped below this
  constexpr float deviations = 5;           // times the typical one of all photos and faces
  std::vector<float> all;
  const auto deviation = [](const Candidate& c, const Eigen::Vector3f& middle) {
    return (c.log_color - middle).cwiseAbs().maxCoeff();
  };
  for (const auto& set : surface.candidates)
    if (set.size() >= 3) {
      const Eigen::Vector3f middle = median_color(set);
      for (const Candidate& c : set) all.push_back(deviation(c, middle));
    }
  if (all.empty()) return 0;
  const float limit = std::max(least_deviation, deviations * 1.5F * median(all));
  std::size_t dropped = 0;
  for (auto& set : surface.candidates) {
    if (set.size() < 3) continue;
    const Eigen::Vector3f middle = median_color(set);
    const auto outlier = [&](const Candidate& c) { return deviation(c, middle) > limit; };
    const auto count = static_cast<std::size_t>(std::count_if(set.begin(), set.end(), outlier));
    // Where photos fall apart into two camps, nobody knows who is right.
    if (count == 0 || 2 * count >= set.size()) continue;
    dropped += count;
    std::erase_if(set, outlier);
  }
  return dropped;
}

}  // namespace drape::texturing
