#include "point_features.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace drape::registration {
namespace {

constexpr int bins = 11;

int bin(double value, double least, double most) {
  return std::clamp(static_cast<int>(bins * (value - least) / (most - least)), 0, bins - 1);
}

// The three angles of Rusu et al. 2009, eq. 1, for the pair whose line is `step`; u is the normal of the
// point that sees the other one at the smaller angle.
void add_pair(Eigen::Ref<Eigen::Matrix<float, 33, 1>> histogram, const Eigen::Vector3d& step, double distance,
              Eigen::Vector3d first, Eigen::Vector3d second) {
  Eigen::Vector3d line = step / distance;
  if (std::abs(first.dot(line)) < std::abs(second.dot(line))) {
    std::swap(first, second);
    line = -line;
  }
  Eigen::Vector3d v = line.cross(first);
  const double length = v.norm();
  if (!(length > 1e-9)) return;
  v /= length;
  const Eigen::Vector3d w = first.cross(v);
  const double theta = std::atan2(w.dot(second), first.dot(second));
  histogram[bin(theta, -std::numbers::pi, std::numbers::pi)] += 1;
  histogram[bins + bin(v.dot(second), -1, 1)] += 1;
  histogram[2 * bins + bin(first.dot(line), -1, 1)] += 1;
}

}  // namespace

Features point_features(const CoarseScan& scan) {
  const NeighborLists& near = scan.neighbors();
  const auto count = static_cast<Eigen::Index>(scan.size());
  Features simple = Features::Zero(33, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto p = static_cast<std::size_t>(i);
    for (std::uint32_t k = near.begin[p]; k < near.begin[p + 1]; ++k) {
      const std::uint32_t q = near.index[k];
      if (near.distance[k] > 0)
        add_pair(simple.col(i), scan.points()[q] - scan.points()[p], static_cast<double>(near.distance[k]),
                 scan.normals()[p], scan.normals()[q]);
    }
    const float sum = simple.col(i).sum();
    if (sum > 0) simple.col(i) /= sum;
  }
  // Each point's own histogram and its neighbours', these by nearness (eq. 2).
  Features features = Features::Zero(33, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto p = static_cast<std::size_t>(i);
    float weights = 0;
    for (std::uint32_t k = near.begin[p]; k < near.begin[p + 1]; ++k) {
      const float weight = static_cast<float>(scan.voxel()) /
                           std::max(near.distance[k], 1e-3F * static_cast<float>(scan.voxel()));
      features.col(i) += weight * simple.col(static_cast<Eigen::Index>(near.index[k]));
      weights += weight;
    }
    if (weights > 0) features.col(i) = (features.col(i) / weights + simple.col(i)).cwiseSqrt().normalized();
  }
  return features;
}

std::vector<FeatureMatch> match_features(const Features& source, const Features& target, std::size_t most) {
  if (source.cols() == 0 || target.cols() == 0) return {};
  struct Best {
    Eigen::Index index = -1;
    float similarity = 0;
  };
  std::vector<Best> of_source(static_cast<std::size_t>(source.cols()));
  std::vector<Best> of_target(static_cast<std::size_t>(target.cols()));
  constexpr Eigen::Index block = 64;  // columns whose products stay in the cache
  Eigen::MatrixXf products;
  for (Eigen::Index begin = 0; begin < target.cols(); begin += block) {
    const Eigen::Index columns = std::min(block, target.cols() - begin);
    products.noalias() = source.transpose() * target.middleCols(begin, columns);
    for (Eigen::Index c = 0; c < columns; ++c) {
      const float* column = products.col(c).data();
      Best& best = of_target[static_cast<std::size_t>(begin + c)];
      for (Eigen::Index r = 0; r < source.cols(); ++r) {
        if (column[r] > best.similarity) best = {r, column[r]};
        Best& row = of_source[static_cast<std::size_t>(r)];
        if (column[r] > row.similarity) row = {begin + c, column[r]};
      }
    }
  }
  std::vector<FeatureMatch> matches;
  for (std::size_t s = 0; s < of_source.size(); ++s) {
    if (of_source[s].index < 0) continue;
    const auto t = static_cast<std::size_t>(of_source[s].index);
    matches.push_back({static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(t), of_source[s].similarity,
                       of_target[t].index == static_cast<Eigen::Index>(s)});
  }
  for (std::size_t t = 0; t < of_target.size(); ++t) {
    if (of_target[t].index < 0) continue;
    const auto s = static_cast<std::size_t>(of_target[t].index);
    if (of_source[s].index != static_cast<Eigen::Index>(t))
      matches.push_back(
          {static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(t), of_target[t].similarity, false});
  }
  std::sort(matches.begin(), matches.end(), [](const FeatureMatch& a, const FeatureMatch& b) {
    return std::tuple(!a.mutual, -a.similarity, a.source, a.target) <
           std::tuple(!b.mutual, -b.similarity, b.source, b.target);
  });
  if (matches.size() > most) matches.resize(most);
  return matches;
}

}  // namespace drape::registration
