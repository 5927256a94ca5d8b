// Registered scans, each in its own colour.
#pragma once

#include <Eigen/Core>
#include <span>

#include "drape/geometry/image.hpp"
#include "drape/geometry/rigid3.hpp"
#include "drape/report/views.hpp"

namespace drape::report {

/// Views of the caller's data: it outlives the call.
struct PlacedScan {
  std::span<const Eigen::Vector3d> positions;
  std::span<const Eigen::Vector3f> normals;  // empty, or one per position
  std::span<const Eigen::Vector3d> dropped;  // points that cleaning took away: drawn small and red
  Rigid3 world_from_scan = Rigid3::Identity();
};

struct ScansPictureStyle {
  ViewStyle view = {.views = 4, .width_px = 560, .height_px = 560};
  Eigen::Vector3f background = Eigen::Vector3f(0.925F, 0.933F, 0.945F);  // sRGB, 0..1
};

/// RGB contact sheet of all scans together from several sides. Points are drawn as large as closes the gaps
/// between them, and shaded so that shape shows even without normals (Boucheny, "Interactive scientific
/// visualization of large datasets: towards a perceptive-based approach", 2009: eye-dome lighting). Points
/// that are not finite are left out; empty without any other. Error{input} if a scan's normals are not one
/// per position.
[[nodiscard]] Image8 scans_picture(std::span<const PlacedScan> scans, const ScansPictureStyle& style = {});

}  // namespace drape::report
