#include "object_evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "region_graph.hpp"
#include "superpixels.hpp"

namespace drape::segmentation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int patch_count = 300;
// Zhu et al., section 4 and 5; colour distances in Lab units, positions in longer sides of the picture.
constexpr double sigma_color = 10;
constexpr double sigma_geodesic = 7;
constexpr double sigma_boundary = 1;
constexpr double sigma_space = 0.25;
constexpr double background_weight = 5;
constexpr double least_affinity = 0.1;
constexpr double least_contrast =
    2;  // Lab units between the most different patches; below it nothing stands out

double gauss(double x, double sigma) {
  return std::exp(-x * x / (2 * sigma * sigma));
}

struct Patches {
  Labels labels;
  std::vector<Region> regions;
  std::vector<std::uint8_t> on_border;  // of the picture or of the box, or outside the box
  std::vector<std::uint8_t> outside;    // mostly outside the box
  MatrixXd color;                       // distances of the mean colours
};

Patches patches_of(const ImageF& lab, const Hints& hints) {
  Patches p;
  p.labels = superpixels(lab, patch_count);
  p.regions = region_graph(p.labels, lab);
  const std::size_t n = p.regions.size();
  const std::array<int, 4> box = hints.box.value_or(std::array<int, 4>{0, 0, lab.width(), lab.height()});
  std::vector<int> pixels_outside(n, 0);
  p.on_border.assign(n, 0);
  for (int y = 0; y < lab.height(); ++y)
    for (int x = 0; x < lab.width(); ++x) {
      const auto label = static_cast<std::size_t>(p.labels.at(x, y));
      if (x <= box[0] || y <= box[1] || x + 1 >= box[2] || y + 1 >= box[3]) p.on_border[label] = 1;
      if (x < box[0] || y < box[1] || x >= box[2] || y >= box[3]) ++pixels_outside[label];
    }
  for (std::size_t i = 0; i < n; ++i) p.outside.push_back(2 * pixels_outside[i] > p.regions[i].pixels);
  p.color.resize(static_cast<Index>(n), static_cast<Index>(n));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      p.color(static_cast<Index>(i), static_cast<Index>(j)) =
          std::sqrt(squared_difference(p.regions[i].lab.data(), p.regions[j].lab.data()));
  return p;
}

// Shortest paths over touching patches, each step as long as the colours differ beyond the usual small
// differences (equation 3 there). All patches on the border count as touching each other.
MatrixXd geodesic_distances(const Patches& p) {
  const Index n = p.color.rows();
  double usual = 0;
  for (Index i = 0; i < n; ++i) {
    double least = std::numeric_limits<double>::max();
    for (const auto& [j, sides] : p.regions[static_cast<std::size_t>(i)].neighbors)
      least = std::min(least, p.color(i, j));
    usual += n > 1 ? least / static_cast<double>(n) : 0;
  }
  const auto step = [&](Index i, Index j) { return std::max(0.0, p.color(i, j) - usual); };
  MatrixXd distance = MatrixXd::Constant(n, n, std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, Index>;
  for (Index source = 0; source < n; ++source) {
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    distance(source, source) = 0;
    open.push({0, source});
    while (!open.empty()) {
      const auto [d, i] = open.top();
      open.pop();
      if (d > distance(i, source)) continue;
      const auto relax = [&](Index j) {
        if (d + step(i, j) >= distance(j, source)) return;
        distance(j, source) = d + step(i, j);
        open.push({distance(j, source), j});
      };
      for (const auto& [j, sides] : p.regions[static_cast<std::size_t>(i)].neighbors) relax(j);
      if (p.on_border[static_cast<std::size_t>(i)])
        for (Index j = 0; j < n; ++j)
          if (p.on_border[static_cast<std::size_t>(j)]) relax(j);
    }
  }
  return distance;
}

// Equations 2 to 6: the length of border that a patch hangs together with, against its spanning area.
VectorXd background_probability(const Patches& p, const MatrixXd& geodesic) {
  VectorXd probability(geodesic.rows());
  for (Index i = 0; i < geodesic.rows(); ++i) {
    double area = 0;
    double border = 0;
    for (Index j = 0; j < geodesic.rows(); ++j) {
      const double together = gauss(geodesic(i, j), sigma_geodesic);
      area += together;
      if (p.on_border[static_cast<std::size_t>(j)]) border += together;
    }
    probability[i] = 1 - gauss(border / std::sqrt(area), sigma_boundary);
    if (p.outside[static_cast<std::size_t>(i)]) probability[i] = 1;
  }
  return probability;
}

// Equation 8: contrast with nearby patches that are likely background. 0..1.
VectorXd weighted_contrast(const Patches& p, const VectorXd& background, const ImageF& lab) {
  const double side = std::max(lab.width(), lab.height());
  VectorXd contrast = VectorXd::Zero(background.size());
  for (Index i = 0; i < contrast.size(); ++i) {
    const Region& a = p.regions[static_cast<std::size_t>(i)];
    if (p.outside[static_cast<std::size_t>(i)]) continue;
    for (Index j = 0; j < contrast.size(); ++j) {
      const Region& b = p.regions[static_cast<std::size_t>(j)];
      const double apart = std::hypot(a.x - b.x, a.y - b.y) / side;
      contrast[i] += p.color(i, j) * gauss(apart, sigma_space) * background[j];
    }
  }
  const double most = contrast.maxCoeff();
  return most > 0 ? VectorXd(contrast / most) : contrast;
}

// Equation 9: background, foreground and smoothness terms by least squares.
VectorXd optimized(const Patches& p, const VectorXd& background, const VectorXd& foreground) {
  const Index n = background.size();
  MatrixXd system = MatrixXd::Zero(n, n);
  const auto tie = [&](Index i, Index j) {
    const double weight = gauss(p.color(i, j), sigma_color) + least_affinity;
    system(i, j) -= weight;
    system(i, i) += weight;
  };
  for (Index i = 0; i < n; ++i)
    for (const auto& [j, sides] : p.regions[static_cast<std::size_t>(i)].neighbors) tie(i, j);
  for (Index i = 0; i < n; ++i) system(i, i) += background_weight * background[i] + foreground[i] + 1e-9;
  return system.ldlt().solve(foreground);
}

}  // namespace

ImageF object_evidence(const ImageF& lab, const Hints& hints) {
  ImageF evidence(lab.width(), lab.height(), 1, 0.F);
  const Patches p = patches_of(lab, hints);
  if (p.color.maxCoeff() < least_contrast) return evidence;
  const MatrixXd geodesic = geodesic_distances(p);
  VectorXd background = background_probability(p, geodesic);
  VectorXd foreground = weighted_contrast(p, background, lab);
  if (hints.click) {
    const Index at = p.labels.at((*hints.click)[0], (*hints.click)[1]);
    for (Index i = 0; i < background.size(); ++i) {
      const double near = gauss(geodesic(i, at), sigma_geodesic);
      background[i] *= 1 - near;
      foreground[i] = std::max(foreground[i], near);
    }
    background[at] = 0;
    foreground[at] = 1e3;
  }
  VectorXd value = optimized(p, background, foreground);
  value.array() -= value.minCoeff();
  if (value.maxCoeff() > 0) value /= value.maxCoeff();
  for (std::size_t i = 0; i < evidence.data().size(); ++i)
    evidence.data()[i] = static_cast<float>(value[p.labels.data()[i]]);
  return evidence;
}

}  // namespace drape::segmentation
