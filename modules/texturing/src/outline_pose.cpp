#include "outline_pose.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "distance_field.hpp"
#include "drape/rendering/depth_raster.hpp"

namespace drape::texturing {
namespace {

constexpr int most_side = 1024;  // of the pictures that are drawn here
constexpr int most_drawings = 6;
constexpr double settled_px = 0.03;
constexpr double outline_sigma_px = 0.5;
constexpr double correlated_px = 8;  // errors of stencils go on along the outline for so long
constexpr std::size_t least_points = 60;

struct RimPoint {
  Eigen::Vector3d point;  // in the world
  double distance;        // of its pixel to the model's own outline
};

// By areas: object where most of a pixel's area is, unknown where any of it is.
Image8 reduced(const Image8& stencil, int width, int height) {
  if (stencil.width() == width && stencil.height() == height) return stencil;
  Image8 small(width, height, 1, stencil::background);
  for (int y = 0; y < height; ++y) {
    const int top = static_cast<int>(static_cast<std::int64_t>(y) * stencil.height() / height);
    const int bottom = static_cast<int>(static_cast<std::int64_t>(y + 1) * stencil.height() / height);
    for (int x = 0; x < width; ++x) {
      const int left = static_cast<int>(static_cast<std::int64_t>(x) * stencil.width() / width);
      const int right = static_cast<int>(static_cast<std::int64_t>(x + 1) * stencil.width() / width);
      int object = 0;
      bool unknown = false;
      for (int v = top; v < bottom; ++v)
        for (int u = left; u < right; ++u) {
          object += stencil.at(u, v) == stencil::object ? 1 : 0;
          unknown = unknown || stencil.at(u, v) == stencil::unknown;
        }
      if (unknown)
        small.at(x, y) = stencil::unknown;
      else if (2 * object > (bottom - top) * (right - left))
        small.at(x, y) = stencil::object;
    }
  }
  return small;
}

bool known_round(const Image8& stencil, int x, int y) {
  constexpr int reach = 3;
  for (int dy = -reach; dy <= reach; dy += reach)
    for (int dx = -reach; dx <= reach; dx += reach)
      if (!stencil.contains(x + dx, y + dy) || stencil.at(x + dx, y + dy) == stencil::unknown) return false;
  return true;
}

std::vector<RimPoint> rim_of(const ImageF& depth, const Camera& camera, const Image8& stencil) {
  Image8 drawn(depth.width(), depth.height(), 1, stencil::background);
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x)
      if (std::isfinite(depth.at(x, y))) drawn.at(x, y) = stencil::object;
  const DistanceField own(drawn, 1);
  std::vector<RimPoint> rim;
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 0; x < depth.width(); ++x) {
      if (drawn.at(x, y) != stencil::object || own.values().at(x, y) > 1.2F) continue;
      if (!known_round(stencil, x, y)) continue;
      rim.push_back({camera.unproject({x + 0.5, y + 0.5}, depth.at(x, y)), own.values().at(x, y)});
    }
  return rim;
}

double robust_weight(double miss, double scale) {
  const double trust = 1 / (1 + miss * miss / (scale * scale));
  return trust * trust;
}

double mean_miss(const std::vector<RimPoint>& rim, const Camera& camera, const DistanceField& photo,
                 double most) {
  double sum = 0;
  for (const RimPoint& p : rim)
    sum += std::min(most, std::abs(photo.at(camera.project(p.point).pixel) - p.distance));
  return sum / static_cast<double>(rim.size());
}

// Distances count once per correlated stretch of the outline.
PoseMatrix normal_of(const std::vector<RimPoint>& rim, const PoseFrame& frame, const DistanceField& photo,
                     double scale, double most, PoseStep& right) {
  constexpr double weight_of_one = 1 / (correlated_px * outline_sigma_px * outline_sigma_px);
  PoseMatrix normal = PoseMatrix::Zero();
  right.setZero();
  for (const RimPoint& p : rim) {
    const Eigen::Vector2d pixel = frame.camera().project(p.point).pixel;
    const double miss = photo.at(pixel) - p.distance;
    const Eigen::Vector2d slope = photo.slope_at(pixel);
    if (std::abs(miss) > most || slope.norm() < 0.3) continue;
    const PoseStep row = frame.jacobian(p.point).transpose() * slope.normalized();
    const double weight = weight_of_one * robust_weight(miss, scale);
    normal.noalias() += weight * row * row.transpose();
    right -= weight * miss * row;
  }
  return normal;
}

double farthest_moved(const std::vector<RimPoint>& rim, const Camera& from, const Camera& to) {
  double most = 0;
  for (const RimPoint& p : rim)
    most = std::max(most, (from.project(p.point).pixel - to.project(p.point).pixel).norm());
  return most;
}

}  // namespace

OutlinePose pose_on_outline(const TriangleMesh& mesh, const Camera& camera, const Image8& stencil,
                            const Eigen::Vector3d& middle, double most_px) {
  OutlinePose out{camera};
  if (stencil.empty() || most_px <= 0) return out;
  const double factor = std::min(1.0, static_cast<double>(most_side) / std::max(camera.width, camera.height));
  const Camera given = factor == 1 ? camera
                                   : camera.resized(std::max(1, static_cast<int>(camera.width * factor)),
                                                    std::max(1, static_cast<int>(camera.height * factor)));
  const Image8 outline = reduced(stencil, given.width, given.height);
  const DistanceField photo(outline, 1);
  const double most = std::max(1.0, most_px * factor) + 1;
  Camera now = given;
  Camera best = given;
  double least_miss = 0;
  double first_miss = 0;
  std::vector<RimPoint> first_rim;
  rendering::DepthMap best_map;
  for (int drawing = 0; drawing < most_drawings; ++drawing) {
    rendering::DepthMap map = rendering::rastered_depth(mesh, now);
    const std::vector<RimPoint> rim = rim_of(map.depth, now, outline);
    if (rim.size() < least_points) return out;
    const double miss = mean_miss(rim, now, photo, most);
    const PoseFrame frame(now, middle);
    // From where errors of many pixels count down to where those of stencils stop to count.
    const double scale = std::max(1.5, 1.5 * miss);
    PoseStep right;
    const PoseMatrix normal = normal_of(rim, frame, photo, scale, most, right);
    if (drawing == 0) {
      first_rim = rim;
      first_miss = miss;
      out.miss_px = miss / factor;
      if (factor == 1) out.map = map;
    }
    if (drawing == 0 || miss < least_miss) {
      least_miss = miss;
      best = now;
      out.hold = normal;
      best_map = std::move(map);
    }
    if (drawing == 0 && miss < negligible_miss_px) return out;
    const PoseStep step = (normal + prior_on_steps()).ldlt().solve(right);
    const Camera next = frame.moved(step);
    const double moved = farthest_moved(rim, now, next);
    if (!(moved < 2 * most)) break;
    now = next;
    if (moved < settled_px) break;
  }
  constexpr double worth_it = 0.9;  // of the miss before
  const double moved = farthest_moved(first_rim, given, best) / factor;
  if (least_miss > worth_it * first_miss || moved > most_px) return out;
  out.camera = best;
  if (factor != 1) out.camera = best.resized(camera.width, camera.height);
  out.moved_px = moved;
  out.miss_px = least_miss / factor;
  if (factor == 1) out.map = std::move(best_map);
  return out;
}

}  // namespace drape::texturing
