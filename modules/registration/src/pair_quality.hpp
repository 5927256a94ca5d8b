// How well scans lie on each other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "drape/geometry/rigid3.hpp"
#include "scan_surface.hpp"

namespace drape::registration {

/// How a scan's sampled points lie on other surfaces.
struct Fit {
  std::size_t samples = 0;
  std::size_t matched = 0;
  double squares = 0;         // sum of squared plane distances of the matched
  double scaled_squares = 0;  // the same of distances divided by SurfaceMatch::scale

  [[nodiscard]] double overlap() const {
    return samples > 0 ? static_cast<double>(matched) / static_cast<double>(samples) : 0.0;
  }
  [[nodiscard]] double rms() const;
  [[nodiscard]] double scaled_rms() const;
};

/// Distance within which points count as lying on a surface: 3 spacings, more where noise is larger than
/// that.
[[nodiscard]] double fine_reach(std::span<const ScanSurface> surfaces);

/// Of one surface, its samples that lie on others: on each, and on any of them (`any.squares` has the mean
/// over the surfaces that a sample lies on).
struct FitOnOthers {
  Fit any;
  std::vector<Fit> each;  // one for each of the others; empty for itself
};

/// Of surfaces[which], on those of the others that `use` does not mask with 0.
[[nodiscard]] FitOnOthers fit_on_others(std::size_t which, std::span<const ScanSurface> surfaces,
                                        std::span<const Rigid3> world_from_scan,
                                        std::span<const std::uint8_t> use, double reach);

/// The same for all surfaces that `use` does not mask; the others' fits are empty.
[[nodiscard]] std::vector<FitOnOthers> measure_fits(std::span<const ScanSurface> surfaces,
                                                    std::span<const Rigid3> world_from_scan,
                                                    std::span<const std::uint8_t> use, double reach);

/// Mean over the scans of the squared distance to the others, where points that lie on none count as
/// `reach`: what refinement must not make larger.
[[nodiscard]] double truncated_mean_square(const std::vector<FitOnOthers>& fits, double reach);

}  // namespace drape::registration
