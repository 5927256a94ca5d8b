#include "region_graph.hpp"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

namespace drape::segmentation {
namespace {

// Regions that grow by joining, each standing for itself and all that it took in.
class Merging {
 public:
  explicit Merging(std::vector<Region> regions) : regions_(std::move(regions)), parent_(regions_.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  [[nodiscard]] int root(int i) {
    while (parent_[index(i)] != i) i = parent_[index(i)] = parent_[index(parent_[index(i)])];
    return i;
  }
  [[nodiscard]] const Region& operator[](int i) const { return regions_[index(i)]; }
  [[nodiscard]] int size() const { return static_cast<int>(regions_.size()); }

  [[nodiscard]] float difference(int a, int b) const {
    return squared_difference(regions_[index(a)].lab.data(), regions_[index(b)].lab.data());
  }

  // The neighbour of the most similar colour, or -1.
  [[nodiscard]] int most_similar(int i) const {
    int best = -1;
    for (const auto& [other, sides] : regions_[index(i)].neighbors)
      if (best < 0 || difference(i, other) < difference(i, best)) best = other;
    return best;
  }

  // `from` becomes part of `into`.
  void join(int from, int into) {
    Region& a = regions_[index(into)];
    Region& b = regions_[index(from)];
    const float share = static_cast<float>(b.pixels) / static_cast<float>(a.pixels + b.pixels);
    for (std::size_t c = 0; c < 3; ++c) a.lab[c] += share * (b.lab[c] - a.lab[c]);
    a.pixels += b.pixels;
    a.neighbors.erase(from);
    for (const auto& [other, sides] : b.neighbors) {
      if (other == into) continue;
      a.neighbors[other] += sides;
      auto& back = regions_[index(other)].neighbors;
      back.erase(from);
      back[into] += sides;
    }
    b.neighbors.clear();
    parent_[index(from)] = into;
  }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  std::vector<Region> regions_;
  std::vector<int> parent_;
};

void join_small(Merging& regions, double least_pixels) {
  std::set<std::pair<int, int>> small;
  for (int i = 0; i < regions.size(); ++i)
    if (regions[i].pixels < least_pixels) small.insert({regions[i].pixels, i});
  while (!small.empty()) {
    const int i = small.begin()->second;
    small.erase(small.begin());
    const int into = regions.most_similar(i);
    if (into < 0) return;  // the whole picture is one region
    small.erase({regions[into].pixels, into});
    regions.join(i, into);
    if (regions[into].pixels < least_pixels) small.insert({regions[into].pixels, into});
  }
}

void join_similar(Merging& regions, double least_difference) {
  const auto limit = static_cast<float>(least_difference * least_difference);
  for (bool joined = true; joined;) {
    joined = false;
    for (int i = 0; i < regions.size(); ++i) {
      if (regions.root(i) != i) continue;
      const int other = regions.most_similar(i);
      if (other < 0 || regions.difference(i, other) >= limit) continue;
      regions.join(std::max(i, other), std::min(i, other));
      joined = true;
    }
  }
}

Labels renumbered(const Labels& labels, const std::vector<int>& name) {
  Labels out = labels;
  for (std::int32_t& label : out.data()) label = name[static_cast<std::size_t>(label)];
  return out;
}

int label_count(const Labels& labels) {
  return 1 + *std::max_element(labels.data().begin(), labels.data().end());
}

}  // namespace

Labels connected_regions(const Labels& labels) {
  Labels regions(labels.width(), labels.height(), 1, -1);
  std::vector<std::pair<int, int>> open;
  std::int32_t count = 0;
  for (int y = 0; y < labels.height(); ++y)
    for (int x = 0; x < labels.width(); ++x) {
      if (regions.at(x, y) >= 0) continue;
      regions.at(x, y) = count;
      open.assign(1, {x, y});
      while (!open.empty()) {
        const auto [px, py] = open.back();
        open.pop_back();
        for (const auto& [nx, ny] : {std::pair{px - 1, py}, {px + 1, py}, {px, py - 1}, {px, py + 1}}) {
          if (!labels.contains(nx, ny) || regions.at(nx, ny) >= 0) continue;
          if (labels.at(nx, ny) != labels.at(x, y)) continue;
          regions.at(nx, ny) = count;
          open.emplace_back(nx, ny);
        }
      }
      ++count;
    }
  return regions;
}

std::vector<Region> region_graph(const Labels& labels, const ImageF& lab) {
  const auto count = static_cast<std::size_t>(label_count(labels));
  std::vector<Region> regions(count);
  std::vector<std::array<double, 5>> sums(count, std::array<double, 5>{});
  const auto touch = [&](std::int32_t a, std::int32_t b) {
    if (a == b) return;
    ++regions[static_cast<std::size_t>(a)].neighbors[b];
    ++regions[static_cast<std::size_t>(b)].neighbors[a];
  };
  for (int y = 0; y < labels.height(); ++y)
    for (int x = 0; x < labels.width(); ++x) {
      const auto label = static_cast<std::size_t>(labels.at(x, y));
      ++regions[label].pixels;
      for (int c = 0; c < 3; ++c) sums[label][static_cast<std::size_t>(c)] += lab.at(x, y, c);
      sums[label][3] += x;
      sums[label][4] += y;
      if (x == 0 || y == 0 || x + 1 == labels.width() || y + 1 == labels.height())
        ++regions[label].border_pixels;
      if (x > 0) touch(labels.at(x - 1, y), labels.at(x, y));
      if (y > 0) touch(labels.at(x, y - 1), labels.at(x, y));
    }
  for (std::size_t i = 0; i < count; ++i) {
    const auto mean = [&](std::size_t k) { return static_cast<float>(sums[i][k] / regions[i].pixels); };
    regions[i].lab = {mean(0), mean(1), mean(2)};
    regions[i].x = mean(3);
    regions[i].y = mean(4);
  }
  return regions;
}

Labels merged_regions(const Labels& labels, const ImageF& lab, double least_pixels, double least_difference) {
  Merging regions(region_graph(labels, lab));
  join_small(regions, least_pixels);
  join_similar(regions, least_difference);
  std::vector<int> roots(static_cast<std::size_t>(regions.size()));
  for (int i = 0; i < regions.size(); ++i) roots[static_cast<std::size_t>(i)] = regions.root(i);
  return connected_regions(renumbered(labels, roots));
}

Labels largest_first(const Labels& labels) {
  std::vector<int> pixels(static_cast<std::size_t>(label_count(labels)), 0);
  for (const std::int32_t label : labels.data()) ++pixels[static_cast<std::size_t>(label)];
  std::vector<int> order(pixels.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return pixels[static_cast<std::size_t>(a)] > pixels[static_cast<std::size_t>(b)];
  });
  std::vector<int> name(pixels.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    name[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  return renumbered(labels, name);
}

}  // namespace drape::segmentation
