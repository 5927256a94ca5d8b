#include "drape/geometry/ordered_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/spatial_order.hpp"

namespace drape {
namespace {

constexpr std::size_t buckets_per_chunk = 512;
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float rounding = 1e-5F;  // of squared distances
// A walk reaches this much further than the points before it needed on the average. Where that is not enough
// it reaches further, twice; then the point is looked up by itself.
constexpr float reach_margin = 1.12F;
constexpr float further = 1.5F;
constexpr int walks = 3;
// So is one that lies much denser than the points before it: distances are floats relative to the reach.
constexpr std::size_t crowd = 8;
// Floats relative to the origin of a bucket this much wider than the distance of interest are too coarse for
// it.
constexpr float widest = 16;
constexpr float largest_bucket_reaches = 3;  // the points of a larger one are swept one by one

Eigen::Array3f rounded(const Eigen::Vector3d& v) {
  constexpr double largest = 1e18;  // its square is still finite
  return v.array().max(-largest).min(largest).cast<float>();
}

template <class Lanes>
Lanes squared_lengths(const std::array<Lanes, 3>& places, const Eigen::Array3f& from) {
  return (places[0] - from[0]).square() + (places[1] - from[1]).square() + (places[2] - from[2]).square();
}

}  // namespace

OrderedPoints::OrderedPoints(std::span<const Eigen::Vector3d> points)
    : OrderedPoints(points, morton_order(points)) {}

OrderedPoints::OrderedPoints(std::span<const Eigen::Vector3d> points, std::vector<std::uint32_t> order)
    : order_(std::move(order)), points_(order_.size()) {
  constexpr std::size_t chunk = 1 << 14;
  parallel_for(order_.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points_[i] = points[order_[i]];
  });
  build();
}

// A float may be off by half a unit in its last place: the box holds the point all the same.
OrderedPoints::Box OrderedPoints::box_of(const Eigen::Vector3d& point) const {
  const Eigen::Array3f place = rounded(point - center_);
  const Eigen::Array3f margin = place.abs() * std::numeric_limits<float>::epsilon();
  return {place - margin, place + margin};
}

OrderedPoints::Box OrderedPoints::box_of_bucket(std::size_t bucket) const {
  Box box = box_of(points_[bucket * width]);
  for (std::size_t i = bucket * width + 1; i < std::min(points_.size(), (bucket + 1) * width); ++i) {
    const Box other = box_of(points_[i]);
    box.least = box.least.min(other.least);
    box.most = box.most.max(other.most);
  }
  return box;
}

void OrderedPoints::build() {
  if (points_.empty()) return;
  const BoundingBox all = bounding_box(points_);
  center_ = 0.5 * all.min() + 0.5 * all.max();
  const auto divided = [](std::size_t count) { return (count + width - 1) / width; };
  buckets_.resize(divided(points_.size()));
  std::vector<Box> boxes(buckets_.size());
  parallel_for(buckets_.size(), buckets_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      boxes[b] = box_of_bucket(b);
      Bucket& bucket = buckets_[b];
      bucket.origin = points_[b * width];
      bucket.extent = (boxes[b].most - boxes[b].least).maxCoeff();
      for (Lanes& lanes : bucket.offsets) lanes.setConstant(std::numeric_limits<float>::quiet_NaN());
      for (std::size_t i = b * width; i < std::min(points_.size(), (b + 1) * width); ++i) {
        const Eigen::Array3f offset = rounded(points_[i] - bucket.origin);
        for (std::size_t axis = 0; axis < 3; ++axis)
          bucket.offsets[axis][static_cast<Eigen::Index>(i - b * width)] =
              offset[static_cast<Eigen::Index>(axis)];
      }
    }
  });
  do {
    std::vector<Node>& nodes = levels_.emplace_back(divided(boxes.size()));
    std::vector<Box> own(nodes.size());
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      for (Lanes& lanes : nodes[n].least) lanes.setConstant(infinity);
      for (Lanes& lanes : nodes[n].most) lanes.setConstant(-infinity);
      own[n] = boxes[n * width];
      for (std::size_t c = n * width; c < std::min(boxes.size(), (n + 1) * width); ++c) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const auto lane = static_cast<Eigen::Index>(c - n * width);
          nodes[n].least[axis][lane] = boxes[c].least[static_cast<Eigen::Index>(axis)];
          nodes[n].most[axis][lane] = boxes[c].most[static_cast<Eigen::Index>(axis)];
        }
        own[n].least = own[n].least.min(boxes[c].least);
        own[n].most = own[n].most.max(boxes[c].most);
      }
    }
    boxes = std::move(own);
  } while (boxes.size() > 1);
}

// Of each child's box to `box`.
OrderedPoints::Lanes OrderedPoints::squared_gaps(const Node& node, const Box& box) {
  const auto along = [&](std::size_t axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    return (node.least[axis] - box.most[a]).max(box.least[a] - node.most[axis]).max(0.0F).square().eval();
  };
  return along(0) + along(1) + along(2);
}

template <class Visit>
void OrderedPoints::for_each_bucket_near(const Box& box, float squared_reach, const Visit& visit) const {
  if (levels_.empty()) return;
  struct Waiting {
    std::size_t level;
    std::size_t node;
  };
  std::array<Waiting, 16 * width> stack;  // 16 levels of 8 children are more points than 32 bits count
  std::size_t waiting = 0;
  stack[waiting++] = {levels_.size() - 1, 0};
  const float limit = squared_reach * (1 + rounding);
  while (waiting > 0) {
    const auto [level, node] = stack[--waiting];
    const Lanes gaps = squared_gaps(levels_[level][node], box);
    for (Eigen::Index k = width; k-- > 0;) {
      if (!(gaps[k] <= limit)) continue;
      const std::size_t child = node * width + static_cast<std::size_t>(k);
      if (level == 0)
        visit(child);
      else
        stack[waiting++] = {level - 1, child};
    }
  }
}

void OrderedPoints::within(const Eigen::Vector3d& query, double radius,
                           const std::function<void(std::uint32_t)>& visit) const {
  const auto reach = static_cast<float>(radius * (1 + static_cast<double>(rounding)));
  for_each_bucket_near(box_of(query), reach * reach, [&](std::size_t bucket) {
    for (std::size_t i = bucket * width; i < std::min(points_.size(), (bucket + 1) * width); ++i)
      if ((points_[i] - query).norm() <= radius) visit(static_cast<std::uint32_t>(i));
  });
}

// Depth first, nearer children first; `found` is sorted.
void OrderedPoints::search(std::size_t level, std::size_t node, const Eigen::Vector3d& query,
                           const Box& place, std::span<Near> found, std::size_t& count) const {
  const auto furthest = [&] {
    return count == found.size() ? found[count - 1].squared_distance() : std::numeric_limits<float>::max();
  };
  const Lanes gaps = squared_gaps(levels_[level][node], place) * (1 - rounding);
  std::array<std::pair<float, std::size_t>, width> children;
  std::size_t waiting = 0;
  const float limit = furthest();
  if (!(gaps <= limit).any()) return;
  for (Eigen::Index k = 0; k < width; ++k) {
    if (!(gaps[k] <= limit)) continue;  // nor is there a child infinitely far away
    std::size_t at = waiting++;
    for (; at > 0 && gaps[k] < children[at - 1].first; --at) children[at] = children[at - 1];
    children[at] = {gaps[k], node * width + static_cast<std::size_t>(k)};
  }
  for (std::size_t c = 0; c < waiting; ++c) {
    const auto [gap, child] = children[c];
    if (gap > furthest()) return;
    if (level > 0) {
      search(level - 1, child, query, place, found, count);
      continue;
    }
    const Bucket& bucket = buckets_[child];
    const Lanes squared = squared_lengths(bucket.offsets, rounded(query - bucket.origin));
    const float wide = bucket.extent * bucket.extent / (widest * widest);
    if (!(squared <= std::max(wide, furthest())).any()) continue;
    for (std::size_t i = child * width; i < std::min(points_.size(), (child + 1) * width); ++i) {
      float length = squared[static_cast<Eigen::Index>(i - child * width)];
      if (length < wide) length = rounded(points_[i] - query).square().sum();
      const Near near(length, static_cast<std::uint32_t>(i));
      if (count == found.size() && !(near < found[count - 1])) continue;
      std::size_t at = count < found.size() ? count++ : count - 1;
      for (; at > 0 && near < found[at - 1]; --at) found[at] = found[at - 1];
      found[at] = near;
    }
  }
}

std::size_t OrderedPoints::nearest(const Eigen::Vector3d& query, std::span<Near> found) const {
  if (found.empty() || points_.empty()) return 0;
  std::size_t count = 0;
  search(levels_.size() - 1, 0, query, box_of(query), found, count);
  return count;
}

std::optional<Near> OrderedPoints::nearest_within(const Eigen::Vector3d& query, double radius) const {
  if (points_.empty() || !(radius > 0)) return std::nullopt;
  // Found already, so to say, at the radius: anything nearer takes its place.
  const auto squared_radius = static_cast<float>(radius * radius);
  Near found(squared_radius, 0);
  std::size_t count = 1;
  search(levels_.size() - 1, 0, query, box_of(query), std::span(&found, 1), count);
  return found.squared_distance() < squared_radius ? std::optional(found) : std::nullopt;
}

// The buckets around a place, and what of them lies around a point.
struct OrderedPoints::Candidates {
  struct Block {
    std::array<Lanes, 3> places;  // relative to the origin
    std::uint32_t first;          // index of the first point
  };
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Block> blocks;
  std::vector<Near> near;  // the first `found` of them; the rest is room
  std::size_t found = 0;

  void add(const OrderedPoints& points, std::size_t index, float reach) {
    const Bucket& bucket = points.buckets_[index];
    if (bucket.extent > widest * reach) return add_wide(points, index);
    const Eigen::Array3f shift = rounded(bucket.origin - origin);
    blocks.push_back(
        {{bucket.offsets[0] + shift[0], bucket.offsets[1] + shift[1], bucket.offsets[2] + shift[2]},
         static_cast<std::uint32_t>(index * width)});
  }
  void add_wide(const OrderedPoints& points, std::size_t index) {
    Block& block = blocks.emplace_back();
    block.first = static_cast<std::uint32_t>(index * width);
    for (Lanes& lanes : block.places) lanes.setConstant(std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = index * width; i < std::min(points.size(), (index + 1) * width); ++i) {
      const Eigen::Array3f place = rounded(points.points_[i] - origin);
      for (std::size_t axis = 0; axis < 3; ++axis)
        block.places[axis][static_cast<Eigen::Index>(i - index * width)] =
            place[static_cast<Eigen::Index>(axis)];
    }
  }
  void find_around(const Eigen::Vector3d& point, float squared_reach) {
    const Eigen::Array3f from = rounded(point - origin);
    if (near.size() < blocks.size() * width) near.resize(blocks.size() * width);
    found = 0;
    for (const Block& block : blocks) {
      const Lanes squared = squared_lengths(block.places, from);
      if (!(squared <= squared_reach).any()) continue;
      for (Eigen::Index k = 0; k < width; ++k) {
        near[found] = Near(squared[k], block.first + static_cast<std::uint32_t>(k));
        found += squared[k] <= squared_reach ? 1 : 0;
      }
    }
  }
};

// One chunk of for_each_neighborhood.
struct OrderedPoints::Sweep {
  const OrderedPoints& points;
  std::size_t count;
  const std::function<void(std::size_t, std::span<Near>)>& visit;
  float reach = 0;  // 0: not learnt yet
  Candidates candidates{};
  std::vector<Near> looked_up = std::vector<Near>(count);
  std::vector<std::uint32_t> left{};  // points of a bucket that still wait
  float sum = 0;                      // of the distances that the bucket's points needed

  /// The last of them is the furthest.
  void finish(std::size_t i, std::span<Near> nearest) {
    const float furthest = std::sqrt(nearest.back().squared_distance());
    sum += reach > 0 ? std::min(furthest, further * reach) : furthest;
    visit(i, nearest);
  }

  void look_up(std::size_t i) {
    finish(i, std::span(looked_up).first(points.nearest(points.points_[i], looked_up)));
  }

  /// Finishes those of the points that have enough others within `reach_here`.
  void walk(const Box& box, float reach_here) {
    candidates.origin = points.points_[left.front()];
    candidates.blocks.clear();
    points.for_each_bucket_near(box, reach_here * reach_here,
                                [&](std::size_t bucket) { candidates.add(points, bucket, reach_here); });
    std::erase_if(left, [&](std::uint32_t i) {
      candidates.find_around(points.points_[i], reach_here * reach_here);
      if (candidates.found < count) return false;
      if (candidates.found > crowd * count) {
        look_up(i);
        return true;
      }
      const auto last = candidates.near.begin() + static_cast<std::ptrdiff_t>(count) - 1;
      std::nth_element(candidates.near.begin(), last,
                       candidates.near.begin() + static_cast<std::ptrdiff_t>(candidates.found));
      finish(i, std::span(candidates.near).first(count));
      return true;
    });
  }

  void walk_further(const Box& box) {
    float reach_here = reach;
    for (int k = 0; k < walks && reach > 0 && !left.empty(); ++k, reach_here *= further)
      walk(box, reach_here);
    for (const std::uint32_t i : left) look_up(i);
    left.clear();
  }

  void bucket(std::size_t index) {
    const std::size_t first = index * width;
    const std::size_t last = std::min(points.size(), first + width);
    const Box box = points.box_of_bucket(index);
    const float extent = (box.most - box.least).maxCoeff();
    sum = 0;
    if (extent <= largest_bucket_reaches * reach) {
      for (std::size_t i = first; i < last; ++i) left.push_back(static_cast<std::uint32_t>(i));
      walk_further(box);
    } else {
      for (std::size_t i = first; i < last; ++i) {
        left.push_back(static_cast<std::uint32_t>(i));
        walk_further(points.box_of(points.points_[i]));
      }
    }
    reach = reach_margin * sum / static_cast<float>(last - first);
  }
};

void OrderedPoints::for_each_neighborhood(
    std::size_t count, const std::function<void(std::size_t, std::span<Near>)>& visit) const {
  if (points_.empty() || count == 0) return;
  parallel_for(buckets_.size(), buckets_per_chunk, [&](std::size_t begin, std::size_t end) {
    Sweep sweep{*this, count, visit};
    for (std::size_t bucket = begin; bucket < end; ++bucket) sweep.bucket(bucket);
  });
}

}  // namespace drape
