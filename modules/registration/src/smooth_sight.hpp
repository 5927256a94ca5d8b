// What a scanner saw, without its noise: for small contradictions.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "coarse_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "scan_surface.hpp"
#include "view_projection.hpp"

namespace drape::registration {

/// Shares of all points of a scan, 0..1. Contradictions count in patches only, where most points around show
/// the same: what noise and the rounding of edges leave in front is scattered, what does not belong there is
/// not.
struct SightShares {
  double agreeing = 0;  // on the viewer's surface, facing the same way
  double in_front = 0;  // before all of the surface that the viewer saw there: it looked through them
  double in_void = 0;   // facing the viewer where nothing came back to it
};

/// An image of the scan's points, each moved onto the plane of the coarse point next to it. SightMap asks for
/// points in front of single, noisy ones, so that noise alone must not reach it; here the noise is averaged
/// out, and a third as much shows. Where the field of view is known, so is the void beside the object; gaps
/// within it, which dark or shining surfaces leave too, are none.
class SmoothSight {
 public:
  /// Refers to the surface.
  SmoothSight(const ScanSurface& viewer, const CoarseScan& coarse);

  /// All zero where the view is unknown. `tolerance` is a distance across the surface, at the median range.
  [[nodiscard]] SightShares compare(const CoarseScan& source, const Rigid3& viewer_from_source,
                                    double tolerance) const;

  /// The share of the points that lie in front, whether or not those around them do.
  [[nodiscard]] double in_front_share(const CoarseScan& source, const Rigid3& viewer_from_source,
                                      double tolerance) const;

 private:
  struct Pixel {
    Eigen::Vector3f point = Eigen::Vector3f::Zero();  // from center_
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    float count = 0;
    bool near = false;     // something was seen within a few pixels
    bool outside = false;  // not, nor does what was seen enclose it
  };
  enum class Seen { nothing_told, agreeing, in_front, in_void };

  [[nodiscard]] static bool mostly(const std::vector<Seen>& seen, Seen as, const CoarseScan& scan,
                                   std::size_t which);
  void lay_out();
  void fill(const CoarseScan& coarse);
  void find_outside();
  [[nodiscard]] Eigen::Array2d cell_of(const Eigen::Vector2d& place) const;
  [[nodiscard]] Seen judge(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                           double tolerance) const;
  [[nodiscard]] Seen judge_surface(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                   std::size_t pixel, double tolerance) const;

  const ScanSurface* viewer_;
  std::optional<ViewProjection> projection_;
  Eigen::Vector3d center_;
  double median_range_ = 0;  // 0: parallel rays
  double pixel_ = 1;
  Eigen::Array2d corner_ = Eigen::Array2d::Zero();
  std::ptrdiff_t columns_ = 0;
  std::ptrdiff_t rows_ = 0;
  std::vector<Pixel> pixels_;
};

/// How far across a surface smoothed points may lie off by what noise is left and by curvature.
[[nodiscard]] double smooth_tolerance(const CoarseScan& a, const CoarseScan& b);

}  // namespace drape::registration
