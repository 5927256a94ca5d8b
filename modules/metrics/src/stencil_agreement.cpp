#include "drape/metrics/stencil_agreement.hpp"

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/kd_tree.hpp"

namespace drape::metrics {
namespace {

void require_alike(const Image8& first, const Image8& second) {
  if (first.channels() != 1 || second.channels() != 1)
    throw input_error("a stencil has one channel; these have {} and {}", first.channels(), second.channels());
  if (first.width() != second.width() || first.height() != second.height())
    throw input_error("cannot compare stencils of different sizes: {} x {} and {} x {} pixels", first.width(),
                      first.height(), second.width(), second.height());
}

// Middles of the pixel sides between object and background, where both stencils know both pixels. z is 0.
std::vector<Eigen::Vector3d> outline(const Image8& stencil, const Image8& other) {
  std::vector<Eigen::Vector3d> points;
  const auto known = [&](int x, int y) {
    return stencil.at(x, y) != stencil::unknown && other.at(x, y) != stencil::unknown;
  };
  const auto visit = [&](int x, int y, int next_x, int next_y) {
    if (!stencil.contains(next_x, next_y) || stencil.at(x, y) == stencil.at(next_x, next_y)) return;
    if (known(x, y) && known(next_x, next_y))
      points.emplace_back((x + next_x + 1) / 2.0, (y + next_y + 1) / 2.0, 0.0);
  };
  for (int y = 0; y < stencil.height(); ++y)
    for (int x = 0; x < stencil.width(); ++x) {
      visit(x, y, x + 1, y);
      visit(x, y, x, y + 1);
    }
  return points;
}

std::vector<double> distances(const std::vector<Eigen::Vector3d>& from,
                              const std::vector<Eigen::Vector3d>& to) {
  const KdTree tree(to);
  std::vector<double> found(from.size());
  parallel_for(from.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Neighbor nearest{};
      tree.nearest(from[i], std::span(&nearest, 1));
      found[i] = std::sqrt(nearest.squared_distance);
    }
  });
  return found;
}

}  // namespace

StencilOverlap stencil_overlap(const Image8& first, const Image8& second) {
  require_alike(first, second);
  StencilOverlap overlap;
  for (std::size_t i = 0; i < first.data().size(); ++i) {
    const std::uint8_t a = first.data()[i];
    const std::uint8_t b = second.data()[i];
    if (a == stencil::unknown || b == stencil::unknown) continue;
    if (a == stencil::object && b == stencil::object) ++overlap.both;
    if (a == stencil::object && b != stencil::object) ++overlap.only_first;
    if (a != stencil::object && b == stencil::object) ++overlap.only_second;
  }
  return overlap;
}

std::optional<Distribution> boundary_error_px(const Image8& first, const Image8& second) {
  require_alike(first, second);
  const std::vector<Eigen::Vector3d> a = outline(first, second);
  const std::vector<Eigen::Vector3d> b = outline(second, first);
  if (a.empty() || b.empty()) return std::nullopt;
  std::vector<double> all = distances(a, b);
  const std::vector<double> back = distances(b, a);
  all.insert(all.end(), back.begin(), back.end());
  return distribution(std::move(all));
}

}  // namespace drape::metrics
