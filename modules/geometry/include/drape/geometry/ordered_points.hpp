// Points in Morton order under a tree of boxes: what lies near a point, for all points in one sweep.
#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace drape {

/// One of a point's neighbours; neighbours compare by distance, equal ones by index.
struct Near {
  std::uint64_t key;  // the bits of a float that is not negative sort as the float does

  Near() = default;
  Near(float squared_distance, std::uint32_t index)
      : key(std::uint64_t{std::bit_cast<std::uint32_t>(squared_distance)} << 32 | index) {}
  [[nodiscard]] std::uint32_t index() const { return static_cast<std::uint32_t>(key); }
  [[nodiscard]] float squared_distance() const {
    return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32));
  }
  friend bool operator<(const Near& a, const Near& b) { return a.key < b.key; }
};

/// A copy of points in Morton order. Consecutive points form buckets, consecutive buckets nodes, each with
/// its bounding box: a tree without pointers, as wide or narrow as the points lie, that is made in one pass.
/// Distances are floats, right to a millionth of how far was looked.
class OrderedPoints {
 public:
  /// The points must be finite.
  explicit OrderedPoints(std::span<const Eigen::Vector3d> points);
  /// With their morton_order, where it is known; of part of the points, where it names no more.
  OrderedPoints(std::span<const Eigen::Vector3d> points, std::vector<std::uint32_t> order);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const { return points_; }
  /// Of points()[i], the index in the caller's order.
  [[nodiscard]] std::uint32_t original(std::size_t i) const { return order_[i]; }

  /// The points nearest to `query` into `found`, nearest first; returns how many.
  std::size_t nearest(const Eigen::Vector3d& query, std::span<Near> found) const;

  /// The nearest one closer than `radius`, if there is one: it looks no further than that.
  [[nodiscard]] std::optional<Near> nearest_within(const Eigen::Vector3d& query, double radius) const;

  /// Calls visit(index) for the points within `radius` of `query`.
  void within(const Eigen::Vector3d& query, double radius,
              const std::function<void(std::uint32_t)>& visit) const;

  /// For every point i, on several threads: visit(i, nearest) with the `count` points nearest to it, itself
  /// among them, in any order; fewer where there are not so many. Points of one bucket share one walk through
  /// the tree, and the reach of that walk is learnt from the bucket before.
  void for_each_neighborhood(std::size_t count,
                             const std::function<void(std::size_t, std::span<Near>)>& visit) const;

 private:
  static constexpr Eigen::Index width = 8;  // of buckets and nodes: two registers of four floats
  using Lanes = Eigen::Array<float, width, 1>;
  struct Bucket {
    Eigen::Vector3d origin;
    std::array<Lanes, 3> offsets;  // of the points from the origin; not numbers where there is none
    float extent;                  // longest side of their box
  };
  struct Box {
    Eigen::Array3f least;  // relative to center_, like most
    Eigen::Array3f most;
  };
  struct Node {  // the boxes of its children; infinitely far where there is none
    std::array<Lanes, 3> least;
    std::array<Lanes, 3> most;
  };
  struct Candidates;
  struct Sweep;

  [[nodiscard]] Box box_of(const Eigen::Vector3d& point) const;
  [[nodiscard]] Box box_of_bucket(std::size_t bucket) const;
  void build();
  [[nodiscard]] static Lanes squared_gaps(const Node& node, const Box& box);
  template <class Visit>
  void for_each_bucket_near(const Box& box, float squared_reach, const Visit& visit) const;
  void search(std::size_t level, std::size_t node, const Eigen::Vector3d& query, const Box& place,
              std::span<Near> found, std::size_t& count) const;

  std::vector<std::uint32_t> order_;
  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  std::vector<Bucket> buckets_;
  std::vector<std::vector<Node>> levels_;  // children of the first are buckets; the last is the root
};

}  // namespace drape
