#include "drape/report/scans_picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "color.hpp"
#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "drape/report/contact_sheet.hpp"
#include "point_raster.hpp"

namespace drape::report {
namespace {

constexpr int oversampling = 2;
const Eigen::Vector3f dropped_color(0.85F, 0.1F, 0.15F);

struct Splat {
  Eigen::Vector3d position;
  Eigen::Vector3f normal;  // zero: not known
  float diameter;
  Eigen::Vector3f color;  // linear light
};

// Median distance to the nearest other point, over a part of the points.
double spacing(std::span<const Eigen::Vector3d> all) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& point : all)
    if (point.allFinite()) points.push_back(point);
  if (points.size() < 2) return 0;
  const KdTree tree(points);
  const std::size_t step = std::max<std::size_t>(1, points.size() / 1000);
  std::vector<double> squared;
  for (std::size_t i = 0; i < points.size(); i += step)
    squared.push_back(tree.nearest(points[i], 2).back().squared_distance);
  const auto middle = squared.begin() + static_cast<std::ptrdiff_t>(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  return std::sqrt(*middle);
}

std::vector<Splat> splats_of(std::span<const PlacedScan> scans) {
  std::vector<Splat> splats;
  for (std::size_t s = 0; s < scans.size(); ++s) {
    const PlacedScan& scan = scans[s];
    if (!scan.normals.empty() && scan.normals.size() != scan.positions.size())
      throw input_error("scan {} has {} points and {} normals", s, scan.positions.size(),
                        scan.normals.size());
    const auto distance = static_cast<float>(spacing(scan.positions));
    const Eigen::Vector3f color = linear_from_srgb(item_color(s));
    const Eigen::Matrix3f rotation = scan.world_from_scan.linear().cast<float>();
    for (std::size_t i = 0; i < scan.positions.size(); ++i)
      if (scan.positions[i].allFinite())
        splats.push_back({scan.world_from_scan * scan.positions[i],
                          scan.normals.empty() ? Eigen::Vector3f::Zero().eval() : rotation * scan.normals[i],
                          1.9F * distance, color});
    for (const Eigen::Vector3d& point : scan.dropped)
      if (point.allFinite())
        splats.push_back({scan.world_from_scan * point, Eigen::Vector3f::Zero(), 1.2F * distance,
                          linear_from_srgb(dropped_color)});
  }
  return splats;
}

// What the pictures are framed by: all but far strays, which would make the rest small.
std::vector<Eigen::Vector3d> without_strays(const std::vector<Splat>& splats) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(splats.size());
  for (const Splat& splat : splats) points.push_back(splat.position);
  if (points.empty()) return points;
  const auto quantile = [](std::vector<double> values, double fraction) {
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  };
  Eigen::Vector3d middle;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(), [axis](const auto& p) { return p[axis]; });
    middle[axis] = quantile(values, 0.5);
  }
  std::transform(points.begin(), points.end(), values.begin(),
                 [&](const auto& p) { return (p - middle).norm(); });
  const double reach = 1.05 * quantile(values, 0.998);
  std::erase_if(points, [&](const Eigen::Vector3d& p) { return (p - middle).norm() > reach; });
  return points;
}

Image8 view_of(const std::vector<Splat>& splats, const Camera& camera, const Eigen::Vector3f& background) {
  PointRaster raster(camera.resized(oversampling * camera.width, oversampling * camera.height));
  for (const Splat& splat : splats) {
    const Eigen::Vector3f towards = camera.towards_camera(splat.position).cast<float>();
    // A lamp at the camera; a normal may point either way.
    const float lit = splat.normal.isZero() ? 1.0F : 0.3F + 0.7F * std::abs(splat.normal.dot(towards));
    raster.draw(splat.position, splat.diameter, lit * splat.color);
  }
  return fitted(raster.picture(background), camera.width, camera.height);
}

}  // namespace

Image8 scans_picture(std::span<const PlacedScan> scans, const ScansPictureStyle& style) {
  const std::vector<Splat> splats = splats_of(scans);
  const std::vector<Camera> cameras = cameras_around(without_strays(splats), style.view);
  std::vector<Image8> pictures(cameras.size());
  parallel_for(cameras.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) pictures[i] = view_of(splats, cameras[i], style.background);
  });
  return contact_sheet(pictures, {.cell_width_px = style.view.width_px,
                                  .cell_height_px = style.view.height_px,
                                  .background = style.background});
}

}  // namespace drape::report
