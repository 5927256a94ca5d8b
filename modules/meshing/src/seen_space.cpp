#include "seen_space.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace drape::meshing {
namespace {

// Samples this much farther than a point are behind it: more than noise and registration leave between scans.
constexpr double behind_spacings = 3;
// A gap in a scan is no evidence: the nearest rays must be as close as the lattice lets them.
constexpr double ray_reach_spacings = 1.5;
constexpr std::size_t rays_asked = 4;

}  // namespace

SeenSpace::SeenSpace(const PlacedScans& placed, double spacing) : spacing_(spacing) {
  for (std::size_t i = 0; i < placed.scans.size(); ++i) {
    const RangeScan& scan = placed.scans[i];
    if (scan.view.kind == ScanView::Kind::unknown || scan.cloud.positions.empty()) continue;
    View view{placed.world_from_scan[i].inverse(), scan.view, {}, {}, nullptr};
    view.rays.reserve(scan.cloud.positions.size());
    for (const Eigen::Vector3d& p : scan.cloud.positions) {
      const Ray ray = ray_to(view.view, p);
      view.rays.push_back(ray.key);
      view.depths.push_back(ray.depth);
    }
    views_.push_back(std::move(view));
    views_.back().tree = std::make_unique<KdTree>(views_.back().rays);
  }
}

SeenSpace::Ray SeenSpace::ray_to(const ScanView& view, const Eigen::Vector3d& point) {
  if (view.kind == ScanView::Kind::direction) {
    const double depth = view.vector.dot(point);
    return {point - depth * view.vector, depth};
  }
  const Eigen::Vector3d along = point - view.vector;
  const double depth = along.norm();
  if (depth == 0) return {Eigen::Vector3d::Zero(), 0};  // the scanner itself: on no ray
  return {along / depth, depth};
}

bool SeenSpace::seen_through(const View& view, const Eigen::Vector3d& point_in_world) const {
  const Ray ray = ray_to(view.view, view.scan_from_world * point_in_world);
  std::array<Neighbor, rays_asked> nearest{};
  if (view.tree->nearest(ray.key, nearest) < rays_asked) return false;
  return std::all_of(nearest.begin(), nearest.end(), [&](const Neighbor& n) {
    const double depth = view.depths[n.index];
    double reach = ray_reach_spacings * spacing_;
    // Diverging rays are a spacing apart where the samples are; their keys are angles.
    if (view.view.kind == ScanView::Kind::origin) reach /= std::max(depth, spacing_);
    return n.squared_distance <= reach * reach && depth > ray.depth + behind_spacings * spacing_;
  });
}

bool SeenSpace::seen_through(const Eigen::Vector3d& point_in_world) const {
  return std::any_of(views_.begin(), views_.end(),
                     [&](const View& view) { return seen_through(view, point_in_world); });
}

SeenThroughArea seen_through_area(const SeenSpace& seen, const std::vector<Eigen::Vector3d>& points,
                                  const std::vector<Face>& faces, double spacing) {
  constexpr double most_samples_a_side = 12;  // of a face
  SeenThroughArea sum;
  for (const Face& f : faces) {
    const Eigen::Vector3d to_b = points[f[1]] - points[f[0]];
    const Eigen::Vector3d to_c = points[f[2]] - points[f[0]];
    const double area = to_b.cross(to_c).norm() / 2;
    const auto steps =
        static_cast<int>(std::clamp(std::ceil(std::sqrt(area) / (2 * spacing)), 1.0, most_samples_a_side));
    int hits = 0;
    int samples = 0;
    for (int i = 0; i < steps; ++i)
      for (int k = 0; i + k < steps; ++k) {
        ++samples;
        const Eigen::Vector3d p = points[f[0]] + (i + 1.0 / 3) / steps * to_b + (k + 1.0 / 3) / steps * to_c;
        if (seen.seen_through(p)) ++hits;
      }
    sum.through += area * hits / samples;
    sum.all += area;
  }
  return sum;
}

}  // namespace drape::meshing
