// Which samples of a scan lie beside which.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "drape/base/parallel.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// The eight neighbours of each sample on its scan's lattice, or, without a lattice, its neighbours in a
/// triangulation. Refers to the grid it was made of.
class SampleNeighbors {
 public:
  explicit SampleNeighbors(const RangeGrid& grid) : grid_(&grid) {}
  /// The next corners of each sample's faces: in a closed fan that is every neighbour once.
  SampleNeighbors(const std::vector<Face>& faces, std::size_t samples);

  /// Whether there are neighbours farther off than the next.
  [[nodiscard]] bool has_strides() const { return grid_ != nullptr; }

  /// Calls visit(sample, its neighbours) for each sample, on several threads: on a lattice the eight that are
  /// `stride` rows or columns off.
  template <class Visit>
  void for_all(Visit visit, int stride = 1) const {
    parallel_for(lines(), grid_ ? 8 : 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t line = begin; line < end; ++line) visit_line(line, stride, visit);
    });
  }
  /// The same for some ten thousand samples, in their order.
  template <class Visit>
  void for_some(Visit visit, int stride = 1) const {
    constexpr std::size_t places = 8192;
    // A row of a lattice holds many samples, but they are alike: at least 64 rows.
    const std::size_t step = grid_ ? std::clamp<std::size_t>(grid_->cells.size() / places, 1,
                                                             std::max<std::size_t>(1, lines() / 64))
                                   : std::max<std::size_t>(1, lines() / places);
    for (std::size_t line = 0; line < lines(); line += step) visit_line(line, stride, visit);
  }

 private:
  // Rows of the lattice, or samples.
  [[nodiscard]] std::size_t lines() const {
    return grid_ ? static_cast<std::size_t>(grid_->rows) : first_.size() - 1;
  }
  template <class Visit>
  void visit_line(std::size_t line, int stride, Visit& visit) const {
    if (grid_)
      visit_row(static_cast<int>(line), stride, visit);
    else
      visit(line, std::span(indices_).subspan(first_[line], first_[line + 1] - first_[line]));
  }
  template <class Visit>
  void visit_row(int row, int stride, Visit& visit) const {
    for (int column = 0; column < grid_->columns; ++column) {
      const std::int32_t center = grid_->at(row, column);
      if (center < 0) continue;
      std::array<std::uint32_t, 8> around{};
      std::size_t count = 0;
      for (int r = row - stride; r <= row + stride; r += stride) {
        if (r < 0 || r >= grid_->rows) continue;
        for (int c = column - stride; c <= column + stride; c += stride) {
          if (c < 0 || c >= grid_->columns) continue;
          if (const std::int32_t i = grid_->at(r, c); i >= 0 && i != center)
            around[count++] = static_cast<std::uint32_t>(i);
        }
      }
      visit(static_cast<std::size_t>(center), std::span<const std::uint32_t>(around.data(), count));
    }
  }

  const RangeGrid* grid_ = nullptr;
  std::vector<std::uint32_t> first_;  // sample i's are indices_[first_[i]] .. indices_[first_[i + 1] - 1]
  std::vector<std::uint32_t> indices_;
};

}  // namespace drape::meshing
