// What a scanner saw from where it stood, as a depth map.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "drape/geometry/rigid3.hpp"
#include "scan_surface.hpp"
#include "view_projection.hpp"

namespace drape::registration {

/// The depths that a scan has along its lines of sight. A scanner would have seen what lies in front of them
/// instead of what it did see.
class SightMap {
 public:
  explicit SightMap(const ScanSurface& viewer);

  /// Of the points that the viewer has returns all around, the share that lies more than `tolerance` in front
  /// of them; 0 where nothing can be said: the view is unknown, or fewer than `least_judged` points lie in
  /// it. In right pairs of scans it is next to nothing, in most wrong ones it is not.
  [[nodiscard]] double seen_through_share(std::span<const Eigen::Vector3d> points,
                                          const Rigid3& viewer_from_points, double tolerance) const;
  static constexpr std::size_t least_judged = 30;

  /// Of the points whose surface (with these normals) faces the viewer and that lie within what it saw, the
  /// share that lies where it saw nothing far and wide: there should have been a return. 0 where nothing can
  /// be said.
  [[nodiscard]] double in_void_share(std::span<const Eigen::Vector3d> points,
                                     std::span<const Eigen::Vector3d> normals,
                                     const Rigid3& viewer_from_points) const;

 private:
  /// Its place in pixels.
  [[nodiscard]] std::optional<Sighting> sighting_of(const Eigen::Vector3d& point) const;
  /// The index of the pixel at `place`; -1 outside of the map.
  [[nodiscard]] std::ptrdiff_t pixel_at(const Eigen::Vector2d& place) const;
  void keep_surrounded(const std::vector<float>& nearest);
  void find_void(const std::vector<float>& nearest);

  ScanView view_;
  ViewProjection projection_;
  double pixel_ = 1;
  double median_range_ = 0;  // 0: parallel rays
  Eigen::Array2d corner_ = Eigen::Array2d::Zero();
  Eigen::Index columns_ = 0;
  Eigen::Index rows_ = 0;
  std::vector<float> front_;        // least depth around each pixel; not a number where a neighbour has none
  std::vector<std::uint8_t> void_;  // 1 where nothing was seen far and wide
};

}  // namespace drape::registration
