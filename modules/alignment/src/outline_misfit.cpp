#include "outline_misfit.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace drape::alignment {

OutlineMisfit outline_misfit(const std::vector<OutlinePiece>& pieces, double bridge_px) {
  OutlineMisfit misfit;
  double total = 0;
  // Length that does not fit, in square cells; cells that touch lie together.
  std::map<std::pair<int, int>, double> cells;
  for (const OutlinePiece& piece : pieces) {
    total += piece.length;
    if (piece.fits)
      misfit.fits += piece.length;
    else
      cells[{static_cast<int>(std::floor(piece.at.x() / bridge_px)),
             static_cast<int>(std::floor(piece.at.y() / bridge_px))}] += piece.length;
  }
  if (!(total > 0)) return misfit;
  misfit.fits /= total;
  while (!cells.empty()) {
    double gap = 0;
    std::vector<std::pair<int, int>> open = {cells.begin()->first};
    while (!open.empty()) {
      const auto [x, y] = open.back();
      open.pop_back();
      const auto cell = cells.find({x, y});
      if (cell == cells.end()) continue;
      gap += cell->second;
      cells.erase(cell);
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) open.emplace_back(x + i, y + j);
    }
    misfit.largest_gap = std::max(misfit.largest_gap, gap / total);
  }
  return misfit;
}

}  // namespace drape::alignment
