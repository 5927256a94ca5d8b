// Where two outlines do not fit: all along, or in one place.
#pragma once

#include <vector>

#include "stencil_evidence.hpp"

namespace drape::alignment {

/// Shares of the two outlines' length, 0..1.
struct OutlineMisfit {
  double fits = 0;
  /// What does not fit and lies together: a part that is missing, or something taken along. 0: all fits.
  double largest_gap = 0;
  /// Of what is outside of that gap, how much fits.
  [[nodiscard]] double fits_elsewhere() const { return largest_gap < 1 ? fits / (1 - largest_gap) : 0; }
};

/// Pieces that do not fit lie together where they are no more than about `bridge_px` apart.
[[nodiscard]] OutlineMisfit outline_misfit(const std::vector<OutlinePiece>& pieces, double bridge_px);

}  // namespace drape::alignment
