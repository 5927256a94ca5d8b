// Where a scanner saw something, to a pixel.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drape/geometry/rigid3.hpp"
#include "scan_surface.hpp"
#include "view_projection.hpp"

namespace drape::registration {

/// The picture of what a scanner saw, in pixels of a spacing, and the void round it: where no return lies
/// within two pixels, and which the returns do not enclose.
class Outline {
 public:
  /// Refers to the surface. Nothing is void where the field of view is unknown.
  explicit Outline(const ScanSurface& viewer);

  /// Whether a point (with its normal, in the viewer's frame) faces the viewer from the void: it should have
  /// been seen.
  [[nodiscard]] bool missed(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
  /// The share of every stride-th of such points that it missed; 0 where nothing can be said.
  [[nodiscard]] double missed_share(std::span<const Eigen::Vector3d> points,
                                    std::span<const Eigen::Vector3d> normals,
                                    const Rigid3& viewer_from_points, std::size_t stride) const;

 private:
  enum : std::uint8_t { enclosed, near, outside };

  void lay_out();
  void find_outside();
  [[nodiscard]] Eigen::Array2d cell_of(const Eigen::Vector2d& place) const {
    return (place.array() / pixel_).floor() - corner_;
  }

  const ScanSurface* viewer_;
  std::optional<ViewProjection> projection_;
  double pixel_ = 1;
  Eigen::Array2d corner_ = Eigen::Array2d::Zero();
  std::ptrdiff_t columns_ = 0;
  std::ptrdiff_t rows_ = 0;
  std::vector<std::uint8_t> cells_;
};

}  // namespace drape::registration
