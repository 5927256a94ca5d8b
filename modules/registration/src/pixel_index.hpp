// The points of a scan by where the scanner saw them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drape/geometry/range_scan.hpp"
#include "view_projection.hpp"

namespace drape::registration {

/// An image of the scan whose pixels, as large as the spacing, hold the index of a point: a point on the
/// surface finds its neighbour there by a few look-ups, without a search through a tree. Finds nothing where
/// the view is unknown.
class PixelIndex {
 public:
  /// Refers to the points. `spacing` at the median range.
  PixelIndex(const ScanView& view, std::span<const Eigen::Vector3d> points, double spacing);

  struct Found {
    std::uint32_t index;
    double squared_distance;
  };
  /// The nearest of the points in the pixels around that of `query`.
  [[nodiscard]] std::optional<Found> nearest(const Eigen::Vector3d& query) const;

 private:
  [[nodiscard]] std::optional<Eigen::Array2i> pixel_of(const Eigen::Vector3d& point) const;
  [[nodiscard]] std::optional<Eigen::Array2i> pixel_at(const Eigen::Vector2d& place) const;

  std::span<const Eigen::Vector3d> points_;
  std::optional<ViewProjection> projection_;
  double inverse_pixel_ = 0;
  Eigen::Array2d corner_ = Eigen::Array2d::Zero();  // in pixels
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> indices_;  // with a margin of one pixel all round
};

}  // namespace drape::registration
