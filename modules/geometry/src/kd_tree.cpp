#include "drape/geometry/kd_tree.hpp"

#include <nanoflann.hpp>

namespace drape {
namespace {

struct Points {
  std::span<const Eigen::Vector3d> points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return points.size(); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3,
                                                 std::uint32_t>;

// nanoflann's result set, writing straight into the caller's buffer and ordering ties by index so that the
// answer does not depend on the tree's layout.
class NearestSet {
 public:
  using DistanceType = double;
  /// Takes nothing at or beyond `squared_limit`.
  explicit NearestSet(std::span<Neighbor> buffer, double squared_limit = std::numeric_limits<double>::max())
      : buffer_(buffer), squared_limit_(squared_limit) {}
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] bool full() const { return count_ == buffer_.size(); }
  [[nodiscard]] double worstDist() const {
    return full() ? buffer_[count_ - 1].squared_distance : squared_limit_;
  }
  bool addPoint(double squared_distance, std::uint32_t index) {
    const auto before = [&](const Neighbor& n) {
      return n.squared_distance < squared_distance ||
             (n.squared_distance == squared_distance && n.index < index);
    };
    if (full() && before(buffer_[count_ - 1])) return true;
    std::size_t i = full() ? count_ - 1 : count_++;
    for (; i > 0 && !before(buffer_[i - 1]); --i) buffer_[i] = buffer_[i - 1];
    buffer_[i] = {index, squared_distance};
    return true;
  }

 private:
  std::span<Neighbor> buffer_;
  double squared_limit_;
  std::size_t count_ = 0;
};

}  // namespace

struct KdTree::Impl {
  explicit Impl(std::span<const Eigen::Vector3d> points) : adaptor{points}, tree(3, adaptor) {}
  Points adaptor;
  Tree tree;
};

KdTree::KdTree(std::span<const Eigen::Vector3d> points) : impl_(std::make_unique<Impl>(points)) {}
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

std::size_t KdTree::nearest(const Eigen::Vector3d& query, std::span<Neighbor> found) const {
  if (found.empty() || impl_->adaptor.points.empty()) return 0;
  NearestSet set(found);
  impl_->tree.findNeighbors(set, query.data(), nanoflann::SearchParams());
  return set.size();
}

std::vector<Neighbor> KdTree::nearest(const Eigen::Vector3d& query, std::size_t count) const {
  std::vector<Neighbor> found(std::min(count, impl_->adaptor.points.size()));
  found.resize(nearest(query, std::span<Neighbor>(found)));
  return found;
}

std::optional<Neighbor> KdTree::nearest_within(const Eigen::Vector3d& query, double radius) const {
  if (impl_->adaptor.points.empty()) return std::nullopt;
  Neighbor found{};
  NearestSet set(std::span(&found, 1), radius * radius);
  impl_->tree.findNeighbors(set, query.data(), nanoflann::SearchParams());
  return set.size() > 0 ? std::optional(found) : std::nullopt;
}

std::vector<Neighbor> KdTree::within(const Eigen::Vector3d& query, double radius) const {
  if (impl_->adaptor.points.empty()) return {};
  std::vector<std::pair<std::uint32_t, double>> matches;
  impl_->tree.radiusSearch(query.data(), radius * radius, matches, nanoflann::SearchParams(32, 0.F, false));
  std::vector<Neighbor> found;
  found.reserve(matches.size());
  for (const auto& [index, squared_distance] : matches) found.push_back({index, squared_distance});
  std::sort(found.begin(), found.end(), [](const Neighbor& a, const Neighbor& b) {
    return a.squared_distance < b.squared_distance ||
           (a.squared_distance == b.squared_distance && a.index < b.index);
  });
  return found;
}

}  // namespace drape
