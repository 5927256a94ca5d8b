#include "cleaning_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "drape/geometry/bounding_box.hpp"
#include "drape/report/contact_sheet.hpp"
#include "drape/report/scans_picture.hpp"

namespace drape::stages {
namespace {

constexpr std::size_t most_drawn = 60'000;
constexpr int side_px = 360;
constexpr double most_upright_cosine = 0.95;  // who looks along the vertical sees no up
constexpr double most_level_cosine = 0.7;

struct Drawn {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> normals;
};

// Every n-th.
Drawn thinned(const PointCloud& cloud) {
  const std::size_t step = cloud.size() / most_drawn + 1;
  Drawn drawn;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    drawn.points.push_back(cloud.positions[i]);
    drawn.normals.push_back(cloud.normals[i]);
  }
  return drawn;
}

std::vector<Eigen::Vector3d> dropped_points(const std::vector<Eigen::Vector3d>& raw,
                                            const std::vector<Eigen::Vector3d>& cleaned) {
  std::vector<Eigen::Vector3d> dropped;
  std::size_t kept = 0;
  for (const Eigen::Vector3d& point : raw)
    if (kept < cleaned.size() && point == cleaned[kept])
      ++kept;
    else
      dropped.push_back(point);
  const std::size_t step = dropped.size() / most_drawn + 1;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < dropped.size(); i += step) dropped[drawn++] = dropped[i];
  dropped.resize(drawn);
  return dropped;
}

// In the scan's frame.
Eigen::Vector3d up_of(const RangeScan& scan, const Eigen::Vector3d& front, char up) {
  if (scan.world_from_scan) {
    const Eigen::Vector3d world = Eigen::Vector3d::Unit(std::clamp(up - 'x', 0, 2));
    const Eigen::Vector3d own = scan.world_from_scan->linear().transpose() * world;
    if (std::abs(front.dot(own)) < most_upright_cosine) return own;
  }
  if (front.z() > most_level_cosine) return Eigen::Vector3d::UnitY();
  if (front.z() < -most_level_cosine) return -Eigen::Vector3d::UnitY();
  return Eigen::Vector3d::UnitZ();
}

// From the scanner, and at a right angle to that.
std::array<report::ViewStyle, 2> views_of(const RangeScan& scan, char up_axis) {
  Eigen::Vector3d front = -Eigen::Vector3d::UnitY();
  if (scan.view.kind != ScanView::Kind::unknown && !scan.cloud.empty())
    front = scan.view.towards_scanner(bounding_box(scan.cloud.positions).center());
  const Eigen::Vector3d up = up_of(scan, front, up_axis);
  report::ViewStyle view{.views = 1, .width_px = side_px, .height_px = side_px, .elevation_deg = 0};
  view.up = (up - front * front.dot(up)).normalized();
  view.front = front;
  report::ViewStyle side = view;
  side.front = view.up.cross(front);
  return {view, side};
}

}  // namespace

Image8 cleaning_picture(const RangeScan& raw, const RangeScan& cleaned, char up) {
  const Drawn kept = thinned(cleaned.cloud);
  const std::vector<Eigen::Vector3d> dropped = dropped_points(raw.cloud.positions, cleaned.cloud.positions);
  std::vector<Image8> pictures;
  for (const bool before : {true, false})
    for (const report::ViewStyle& view : views_of(cleaned, up)) {
      report::PlacedScan scan{kept.points, kept.normals, {}, Rigid3::Identity()};
      if (before) scan.dropped = dropped;
      report::ScansPictureStyle style;
      style.view = view;
      pictures.push_back(report::scans_picture(std::array{scan}, style));
    }
  return report::contact_sheet(
      pictures, {.columns = 2, .cell_width_px = side_px, .cell_height_px = side_px, .gap_px = 4});
}

}  // namespace drape::stages
