// Space that a scanner looked through.
#pragma once

#include <memory>
#include <vector>

#include "drape/geometry/kd_tree.hpp"
#include "drape/meshing/hole_filling.hpp"

namespace drape::meshing {

/// The rays of scans whose view is known: between the scanner and its sample there is nothing. A ray without
/// a sample says nothing: it may have met something dark.
class SeenSpace {
 public:
  /// The scans are read here only. `spacing` > 0: of their samples, in the world's unit.
  SeenSpace(const PlacedScans& placed, double spacing);

  [[nodiscard]] bool empty() const { return views_.empty(); }
  /// Whether a scan has samples all round the ray through the point, each of them clearly behind it.
  [[nodiscard]] bool seen_through(const Eigen::Vector3d& point_in_world) const;

 private:
  // Rays as points: directions on the unit sphere, or places on the plane across parallel rays.
  struct View {
    Rigid3 scan_from_world;
    ScanView view;
    std::vector<Eigen::Vector3d> rays;
    std::vector<double> depths;
    std::unique_ptr<KdTree> tree;
  };
  struct Ray {
    Eigen::Vector3d key;
    double depth;
  };
  [[nodiscard]] static Ray ray_to(const ScanView& view, const Eigen::Vector3d& point_in_scan);
  [[nodiscard]] bool seen_through(const View& view, const Eigen::Vector3d& point_in_world) const;

  double spacing_;
  std::vector<View> views_;
};

/// Areas in the world's unit, squared.
struct SeenThroughArea {
  double through = 0;  // that stands in space that was seen through
  double all = 0;
};

/// Of the faces (`faces` over `points`).
[[nodiscard]] SeenThroughArea seen_through_area(const SeenSpace& seen,
                                                const std::vector<Eigen::Vector3d>& points,
                                                const std::vector<Face>& faces, double spacing);

}  // namespace drape::meshing
