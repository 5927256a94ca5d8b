#include "hierarchical_clusters.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "clusters.hpp"
#include "pixel_features.hpp"

namespace drape::segmentation {
namespace {

using Eigen::Index;
using Row = Eigen::Matrix<double, 1, color_position_count>;

constexpr int patch_count = 1000;
constexpr int most_rounds = 20;  // of 2-means; it settles within a few

// How much farther from its centre the error is if two clusters become one.
double ward(double n1, const Row& mean1, double n2, const Row& mean2) {
  return n1 * n2 / (n1 + n2) * (mean1 - mean2).squaredNorm();
}

double total_scatter(const Patches& p) {
  const Row mean = (p.pixels.transpose() * p.mean) / p.pixels.sum();
  return p.scatter_within +
         ((p.mean.rowwise() - mean).rowwise().squaredNorm().array() * p.pixels.array()).sum();
}

// The error that an automatic number of clusters may leave.
double allowed_scatter(const Patches& p) {
  return (1 - explained_share) * total_scatter(p);
}

struct Group {
  std::vector<Index> members;
  double pixels = 0;
  Row mean = Row::Zero();

  void measure(const Patches& p) {
    pixels = 0;
    mean.setZero();
    for (const Index i : members) {
      pixels += p.pixels[i];
      mean += p.pixels[i] * p.mean.row(i);
    }
    if (pixels > 0) mean /= pixels;
  }
};

// The direction in which the group is longest.
Row longest_axis(const Group& group, const Patches& p) {
  Eigen::Matrix<double, color_position_count, color_position_count> covariance;
  covariance.setZero();
  for (const Index i : group.members) {
    const Row offset = p.mean.row(i) - group.mean;
    covariance += p.pixels[i] * offset.transpose() * offset;
  }
  const Eigen::SelfAdjointEigenSolver<decltype(covariance)> solver(covariance);
  return solver.eigenvectors().col(color_position_count - 1).transpose();
}

// 2-means from the halves before and behind the mean along the longest axis.
std::pair<Group, Group> halves(const Group& group, const Patches& p) {
  std::pair<Group, Group> out;
  const Row axis = longest_axis(group, p);
  for (const Index i : group.members)
    ((p.mean.row(i) - group.mean).dot(axis) < 0 ? out.first : out.second).members.push_back(i);
  for (int round = 0; round < most_rounds; ++round) {
    out.first.measure(p);
    out.second.measure(p);
    if (out.first.members.empty() || out.second.members.empty()) return out;
    Group near_first;
    Group near_second;
    for (const Index i : group.members) {
      const double to_first = (p.mean.row(i) - out.first.mean).squaredNorm();
      const double to_second = (p.mean.row(i) - out.second.mean).squaredNorm();
      (to_first < to_second ? near_first : near_second).members.push_back(i);
    }
    if (near_first.members == out.first.members) break;
    out.first.members = std::move(near_first.members);
    out.second.members = std::move(near_second.members);
  }
  out.first.measure(p);
  out.second.measure(p);
  return out;
}

// A cluster, its best split, and how far apart the halves are; 0 if it cannot be split.
struct Splittable {
  Group whole;
  std::pair<Group, Group> parts;
  double apart = 0;

  Splittable(Group group, const Patches& p) : whole(std::move(group)), parts(halves(whole, p)) {
    if (!parts.first.members.empty() && !parts.second.members.empty())
      apart = ward(parts.first.pixels, parts.first.mean, parts.second.pixels, parts.second.mean);
  }
};

}  // namespace

Labels divisive_clusters(const ImageF& lab, std::optional<int> clusters, double position_weight) {
  const Patches p = patches_of(lab, position_weight, patch_count);
  Group all;
  all.members.resize(static_cast<std::size_t>(p.pixels.size()));
  std::iota(all.members.begin(), all.members.end(), Index{0});
  all.measure(p);
  double scatter = total_scatter(p);
  std::vector<Splittable> groups;
  groups.emplace_back(std::move(all), p);
  while (static_cast<int>(groups.size()) < clusters.value_or(most_automatic_clusters)) {
    if (!clusters && scatter <= allowed_scatter(p)) break;
    const auto widest = std::max_element(groups.begin(), groups.end(),
                                         [](const auto& a, const auto& b) { return a.apart < b.apart; });
    if (widest->apart <= 0) break;  // fewer colours than clusters asked for
    scatter -= widest->apart;
    std::pair<Group, Group> parts = std::move(widest->parts);
    *widest = Splittable(std::move(parts.first), p);
    groups.emplace_back(std::move(parts.second), p);
  }
  std::vector<int> cluster_of_patch(static_cast<std::size_t>(p.pixels.size()));
  for (std::size_t k = 0; k < groups.size(); ++k)
    for (const Index i : groups[k].whole.members)
      cluster_of_patch[static_cast<std::size_t>(i)] = static_cast<int>(k);
  return spread(cluster_of_patch, p.labels);
}

namespace {

// Clusters that merge; of each the nearest other is remembered, so that a merge costs one pass.
class Agglomeration {
 public:
  explicit Agglomeration(const Patches& p)
      : mean_(p.mean), pixels_(p.pixels), parent_(static_cast<std::size_t>(p.pixels.size())) {
    std::iota(parent_.begin(), parent_.end(), 0);
    nearest_.resize(parent_.size());
    for (std::size_t i = 0; i < parent_.size(); ++i) find_nearest(i);
  }

  // The least distance between two clusters; infinite if one is left.
  [[nodiscard]] double least_distance() const { return nearest_[closest()].distance; }

  void merge_closest() {
    const std::size_t a = closest();
    const std::size_t b = nearest_[a].other;
    const double sum = pixels_[index(a)] + pixels_[index(b)];
    mean_.row(index(a)) =
        (pixels_[index(a)] * mean_.row(index(a)) + pixels_[index(b)] * mean_.row(index(b))) / sum;
    pixels_[index(a)] = sum;
    parent_[b] = static_cast<int>(a);
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      if (!alive(i)) continue;
      // Ward's distance only grows by merging, so that no other cluster's nearest can come closer.
      if (i == a || nearest_[i].other == a || nearest_[i].other == b) find_nearest(i);
    }
  }

  [[nodiscard]] std::vector<int> clusters() const {
    std::vector<int> name(parent_.size(), -1);
    std::vector<int> out(parent_.size());
    int count = 0;
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      std::size_t root = i;
      while (!alive(root)) root = static_cast<std::size_t>(parent_[root]);
      if (name[root] < 0) name[root] = count++;
      out[i] = name[root];
    }
    return out;
  }

 private:
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    std::size_t other = 0;
  };

  static Index index(std::size_t i) { return static_cast<Index>(i); }
  [[nodiscard]] bool alive(std::size_t i) const { return parent_[i] == static_cast<int>(i); }

  [[nodiscard]] std::size_t closest() const {
    std::size_t best = 0;  // number 0 takes in others and is never taken in: the lower of two survives
    for (std::size_t i = 0; i < parent_.size(); ++i)
      if (alive(i) && nearest_[i].distance < nearest_[best].distance) best = i;
    return best;
  }

  // Among those of a higher number, so that each pair is looked at once.
  void find_nearest(std::size_t i) {
    nearest_[i] = {};
    for (std::size_t j = i + 1; j < parent_.size(); ++j) {
      if (!alive(j)) continue;
      const double distance =
          ward(pixels_[index(i)], mean_.row(index(i)), pixels_[index(j)], mean_.row(index(j)));
      if (distance < nearest_[i].distance) nearest_[i] = {distance, j};
    }
  }

  Eigen::Matrix<double, Eigen::Dynamic, color_position_count, Eigen::RowMajor> mean_;
  Eigen::VectorXd pixels_;
  std::vector<int> parent_;  // itself, or the cluster that took it in
  std::vector<Nearest> nearest_;
};

}  // namespace

Labels agglomerative_clusters(const ImageF& lab, std::optional<int> clusters, double position_weight) {
  const Patches p = patches_of(lab, position_weight, patch_count);
  Agglomeration groups(p);
  double scatter = p.scatter_within;
  const double allowed = allowed_scatter(p);
  for (Index count = p.pixels.size(); count > 1; --count) {
    const double distance = groups.least_distance();
    const bool enough =
        clusters ? count <= *clusters : count <= most_automatic_clusters && scatter + distance > allowed;
    if (enough && distance > 0) break;
    scatter += distance;
    groups.merge_closest();
  }
  return spread(groups.clusters(), p.labels);
}

}  // namespace drape::segmentation
