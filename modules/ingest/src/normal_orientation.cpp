#include "normal_orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "drape/base/parallel.hpp"

namespace drape::ingest {
namespace {

// Sets of normals whose relative signs are settled: a union-find forest in which each node knows whether it
// is flipped against its parent.
class SignedSets {
 public:
  explicit SignedSets(std::size_t count) : parent_(count), flipped_(count, 0), size_(count, 1) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  /// Root, and whether `node` is flipped against it.
  std::pair<std::uint32_t, bool> find(std::uint32_t node) {
    std::uint32_t root = node;
    bool flipped = false;
    while (parent_[root] != root) {
      flipped ^= flipped_[root] != 0;
      root = parent_[root];
    }
    bool rest = flipped;
    while (parent_[node] != root && node != root) {  // path compression
      const bool own = flipped_[node] != 0;
      flipped_[node] = rest ? 1 : 0;
      rest ^= own;
      node = std::exchange(parent_[node], root);
    }
    return {root, flipped};
  }

  void join(std::uint32_t a, std::uint32_t b, bool opposite) {
    auto [root_a, flipped_a] = find(a);
    auto [root_b, flipped_b] = find(b);
    if (root_a == root_b) return;
    if (size_[root_a] < size_[root_b]) std::swap(root_a, root_b);
    parent_[root_b] = root_a;
    flipped_[root_b] = (flipped_a ^ flipped_b ^ opposite) ? 1 : 0;
    size_[root_a] += size_[root_b];
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> flipped_;
  std::vector<std::uint32_t> size_;
};

struct Edge {
  float cost;
  std::uint32_t from;
  std::uint32_t to;
};

constexpr std::size_t graph_neighbors = 10;

// Edges of the neighbourhood graph in the order in which Kruskal (1956) takes them; indices in Morton order.
std::vector<Edge> sorted_edges(const OrderedPoints& points, const std::vector<Eigen::Vector3f>& normals) {
  std::vector<Edge> edges(points.size() * graph_neighbors, Edge{2.0F, 0, 0});
  points.for_each_neighborhood(graph_neighbors + 1, [&](std::size_t i, std::span<Near> near) {
    std::size_t slot = i * graph_neighbors;
    for (const Near& n : near) {
      if (n.index() == i || slot == (i + 1) * graph_neighbors) continue;
      const float cosine = normals[points.original(i)].dot(normals[points.original(n.index())]);
      edges[slot++] = {1.0F - std::abs(cosine), static_cast<std::uint32_t>(i), n.index()};
    }
  });
  std::erase_if(edges, [](const Edge& e) { return e.cost > 1.5F; });
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.cost, a.from, a.to) < std::tie(b.cost, b.from, b.to);
  });
  return edges;
}

}  // namespace

std::vector<Eigen::Vector3f> oriented_to_view(std::vector<Eigen::Vector3f> normals,
                                              std::span<const Eigen::Vector3d> points, const ScanView& view) {
  constexpr std::size_t chunk = 1 << 14;
  parallel_for(normals.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (normals[i].cast<double>().dot(view.towards_scanner(points[i])) < 0) normals[i] = -normals[i];
  });
  return normals;
}

std::vector<Eigen::Vector3f> oriented_by_spanning_tree(std::vector<Eigen::Vector3f> normals,
                                                       const OrderedPoints& points) {
  SignedSets sets(points.size());
  for (const Edge& edge : sorted_edges(points, normals))
    sets.join(edge.from, edge.to,
              normals[points.original(edge.from)].dot(normals[points.original(edge.to)]) < 0);

  struct Part {
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    double count = 0;
    double outward = 0;
  };
  std::vector<Part> parts(points.size());  // by root
  std::vector<std::uint32_t> root(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const auto [set, flipped] = sets.find(i);
    root[i] = set;
    if (flipped) normals[points.original(i)] = -normals[points.original(i)];
    parts[set].centroid += points.points()[i];
    parts[set].count += 1;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Part& part = parts[root[i]];
    part.outward +=
        normals[points.original(i)].cast<double>().dot(points.points()[i] - part.centroid / part.count);
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    if (parts[root[i]].outward < 0) normals[points.original(i)] = -normals[points.original(i)];
  return normals;
}

}  // namespace drape::ingest
