// Sets that are joined again and again.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace drape {

/// Of the numbers 0 .. count - 1, each alone at first. Each set is called by its least member, whatever order
/// they were joined in (Galler and Fischer 1964, with halved paths).
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  [[nodiscard]] std::uint32_t find(std::uint32_t member) {
    while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
    return member;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace drape
