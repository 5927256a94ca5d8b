// A scan as a surface that points of other scans can be compared with.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/ordered_points.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/ingest/point_spacing.hpp"
#include "field_of_view.hpp"
#include "pixel_index.hpp"

namespace drape::registration {

/// A place on a surface that a point of another scan belongs to.
struct SurfaceMatch {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
  double distance;  // of the point to the plane there, signed
  double weight;    // confidence of the surface
  double scale;     // local over median spacing: what lies further off is less certain
};

/// Oriented points of one scan, in its own frame, evenly thinned where there are very many.
class ScanSurface {
 public:
  /// With the normals of the scan's points.
  ScanSurface(const RangeScan& scan, std::span<const Eigen::Vector3f> normals);
  /// The same where the spacing and the morton_order of the points are known.
  ScanSurface(const RangeScan& scan, double scan_spacing, std::span<const std::uint32_t> order,
              std::span<const Eigen::Vector3f> normals);
  // Parts of it refer to its points, which stay where they are when it is moved, but not when it is copied.
  ScanSurface(ScanSurface&&) = default;
  ScanSurface(const ScanSurface&) = delete;
  ScanSurface& operator=(const ScanSurface&) = delete;

  [[nodiscard]] std::size_t size() const { return ordered_.size(); }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& points() const { return ordered_.points(); }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& normals() const { return normals_; }
  [[nodiscard]] const std::vector<double>& confidences() const { return confidences_; }
  [[nodiscard]] const ScanView& view() const { return view_; }
  [[nodiscard]] const FieldOfView& field_of_view() const { return field_of_view_; }
  [[nodiscard]] const BoundingBox& box() const { return box_; }
  /// Median distance of the points that are kept.
  [[nodiscard]] double spacing() const { return spacing_; }
  /// Median distance of all the scan's points.
  [[nodiscard]] double scan_spacing() const { return scan_spacing_; }
  /// Deviation of points from the planes of their neighbours, where the spacing is the median one.
  [[nodiscard]] double noise() const { return noise_; }
  /// Local over median spacing at a point in this scan's frame.
  [[nodiscard]] double scale_at(const Eigen::Vector3d& point) const { return local_spacing_.ratio(point); }
  /// Whether the points span a surface: not if there are too few, or they lie on a line.
  [[nodiscard]] bool is_surface() const { return is_surface_; }

  /// Indices of up to `count` points, evenly spread.
  [[nodiscard]] std::vector<std::uint32_t> sample(std::size_t count) const;

  /// The place on this surface that `point` (in this scan's frame, with `normal`) lies on or near: the
  /// nearest point (or one that is hardly further), if it is within `reach` (which holds where the spacing is
  /// the median one, and grows with it), its normal is within 45 degrees, and `point` does not lie beside the
  /// surface's border (Turk and Levoy 1994).
  [[nodiscard]] std::optional<SurfaceMatch> match(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                                  double reach) const;

 private:
  [[nodiscard]] std::optional<std::uint32_t> nearest(const Eigen::Vector3d& point, double scale,
                                                     double local_reach) const;

  ScanView view_;
  FieldOfView field_of_view_;
  BoundingBox box_;
  double scan_spacing_;
  std::size_t stride_;
  double spacing_;
  ingest::LocalSpacing local_spacing_;
  OrderedPoints ordered_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<double> confidences_;
  std::optional<PixelIndex> pixels_;
  double noise_ = 0;
  bool is_surface_ = false;
};

}  // namespace drape::registration
