#include "drape/geometry/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "drape/geometry/bounding_box.hpp"

namespace drape {
namespace {

using Eigen::Vector3d;

constexpr std::uint32_t leaf_size = 4;
constexpr int bins = 16;
constexpr std::size_t deepest = 128;

double surface(const BoundingBox& box) {
  if (box.isEmpty()) return 0;
  const Vector3d size = box.sizes();
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

}  // namespace

struct RayCaster::Builder {
  RayCaster& caster;
  std::vector<BoundingBox> boxes;

  /// Where to cut the triangles [begin, end): the number that go to the first child, or 0 for a leaf.
  std::uint32_t split(std::uint32_t begin, std::uint32_t end, const BoundingBox& box) {
    if (end - begin <= leaf_size) return 0;
    BoundingBox centers;
    for (std::uint32_t i = begin; i < end; ++i) centers.extend(boxes[i].center());
    Eigen::Index axis = 0;
    const double extent = centers.sizes().maxCoeff(&axis);
    if (!(extent > 0)) return (end - begin) / 2;
    const auto bin_of = [&](const BoundingBox& b) {
      return std::min(bins - 1, static_cast<int>(bins * (b.center()[axis] - centers.min()[axis]) / extent));
    };
    std::array<BoundingBox, bins> bin_boxes;
    std::array<std::uint32_t, bins> counts{};
    for (std::uint32_t i = begin; i < end; ++i) {
      const auto bin = static_cast<std::size_t>(bin_of(boxes[i]));
      bin_boxes[bin].extend(boxes[i]);
      ++counts[bin];
    }
    const int cut = best_cut(bin_boxes, counts, surface(box));
    return partition(begin, end, [&](const BoundingBox& b) { return bin_of(b) <= cut; });
  }

  static int best_cut(const std::array<BoundingBox, bins>& boxes,
                      const std::array<std::uint32_t, bins>& counts, double whole) {
    int best = bins / 2 - 1;
    double least = std::numeric_limits<double>::infinity();
    for (int cut = 0; cut + 1 < bins; ++cut) {
      BoundingBox left;
      BoundingBox right;
      double left_count = 0;
      double right_count = 0;
      for (int b = 0; b < bins; ++b) {
        const auto i = static_cast<std::size_t>(b);
        (b <= cut ? left : right).extend(boxes[i]);
        (b <= cut ? left_count : right_count) += counts[i];
      }
      const double cost = (left_count * surface(left) + right_count * surface(right)) / whole;
      if (left_count > 0 && right_count > 0 && cost < least) {
        least = cost;
        best = cut;
      }
    }
    return best;
  }

  /// Keeps the order within both parts, so that the hierarchy is the same everywhere.
  template <class Predicate>
  std::uint32_t partition(std::uint32_t begin, std::uint32_t end, Predicate first) {
    std::vector<std::pair<BoundingBox, Triangle>> rest;
    std::uint32_t at = begin;
    for (std::uint32_t i = begin; i < end; ++i)
      if (first(boxes[i])) {
        boxes[at] = boxes[i];
        caster.triangles_[at++] = caster.triangles_[i];
      } else {
        rest.emplace_back(boxes[i], caster.triangles_[i]);
      }
    const std::uint32_t count = at - begin;
    for (auto& [box, triangle] : rest) {
      boxes[at] = box;
      caster.triangles_[at++] = triangle;
    }
    return count;
  }

  void build(std::uint32_t begin, std::uint32_t end) {
    BoundingBox box;
    for (std::uint32_t i = begin; i < end; ++i) box.extend(boxes[i]);
    const std::size_t node = caster.nodes_.size();
    caster.nodes_.push_back({box.min(), box.max(), begin, end - begin});
    const std::uint32_t left = split(begin, end, box);
    if (left == 0 || left == end - begin) return;
    caster.nodes_[node].count = 0;
    build(begin, begin + left);
    caster.nodes_[node].first = static_cast<std::uint32_t>(caster.nodes_.size());
    build(begin + left, end);
  }
};

/// The ray, and the axes in which it points along +z (Woop et al., section 3).
struct RayCaster::Ray {
  Vector3d origin;
  Vector3d inverse;
  Eigen::Index kx, ky, kz;
  double shear_x, shear_y, shear_z;

  Ray(const Vector3d& from, const Vector3d& direction) : origin(from), inverse(direction.cwiseInverse()) {
    direction.cwiseAbs().maxCoeff(&kz);
    kx = (kz + 1) % 3;
    ky = (kx + 1) % 3;
    if (direction[kz] < 0) std::swap(kx, ky);
    shear_x = direction[kx] / direction[kz];
    shear_y = direction[ky] / direction[kz];
    shear_z = 1 / direction[kz];
  }

  /// Where the ray enters the box, or infinity. The far side is pushed out by a few rounding errors (Ize
  /// 2013).
  [[nodiscard]] double enters(const Node& node, double max_distance) const {
    double near = 0;
    double far = max_distance;
    for (int axis = 0; axis < 3; ++axis) {
      double a = (node.least[axis] - origin[axis]) * inverse[axis];
      double b = (node.most[axis] - origin[axis]) * inverse[axis];
      if (a > b) std::swap(a, b);
      b *= 1 + 4 * std::numeric_limits<double>::epsilon();
      // A NaN (origin on a face of the box, direction along it) leaves the limits as they are.
      if (a > near) near = a;
      if (b < far) far = b;
    }
    return near <= far ? near : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] std::optional<RayHit> hits(const Triangle& triangle, double max_distance) const {
    double x[3];
    double y[3];
    double z[3];
    for (int i = 0; i < 3; ++i) {
      const Vector3d p = triangle.corners[i] - origin;
      x[i] = p[kx] - shear_x * p[kz];
      y[i] = p[ky] - shear_y * p[kz];
      z[i] = shear_z * p[kz];
    }
    const Vector3d edge(x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]);
    if (edge.minCoeff() < 0 && edge.maxCoeff() > 0) return std::nullopt;
    const double determinant = edge.sum();
    if (determinant == 0) return std::nullopt;
    const Vector3d weights = edge / determinant;
    const double distance = weights.x() * z[0] + weights.y() * z[1] + weights.z() * z[2];
    if (!(distance > 0 && distance < max_distance)) return std::nullopt;
    return RayHit{distance, triangle.face, weights};
  }
};

RayCaster::RayCaster(const TriangleMesh& mesh) {
  Builder builder{*this, {}};
  triangles_.reserve(mesh.faces.size());
  builder.boxes.reserve(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Triangle triangle;
    BoundingBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corners[k] = mesh.vertices[mesh.faces[f][k]];
      box.extend(triangle.corners[k]);
    }
    triangle.face = static_cast<std::uint32_t>(f);
    triangles_.push_back(triangle);
    builder.boxes.push_back(box);
  }
  if (!triangles_.empty()) builder.build(0, static_cast<std::uint32_t>(triangles_.size()));
}

std::optional<RayHit> RayCaster::traverse(const Ray& ray, double max_distance, bool any) const {
  std::optional<RayHit> best;
  if (nodes_.empty()) return best;
  std::array<std::pair<std::uint32_t, double>, deepest> waiting;
  std::size_t depth = 0;
  waiting[depth++] = {0, ray.enters(nodes_[0], max_distance)};
  while (depth > 0) {
    const auto [index, entry] = waiting[--depth];
    const double limit = best ? best->distance : max_distance;
    if (!(entry <= limit)) continue;
    const Node& node = nodes_[index];
    if (node.count == 0) {
      std::pair<std::uint32_t, double> near(index + 1, ray.enters(nodes_[index + 1], limit));
      std::pair<std::uint32_t, double> far(node.first, ray.enters(nodes_[node.first], limit));
      if (far.second < near.second) std::swap(near, far);
      if (std::isfinite(far.second)) waiting[depth++] = far;
      if (std::isfinite(near.second)) waiting[depth++] = near;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const std::optional<RayHit> hit = ray.hits(triangles_[i], max_distance);
      if (!hit) continue;
      if (any) return hit;
      if (!best || hit->distance < best->distance ||
          (hit->distance == best->distance && hit->face < best->face))
        best = hit;
    }
  }
  return best;
}

std::optional<RayHit> RayCaster::first_hit(const Vector3d& origin, const Vector3d& direction,
                                           double max_distance) const {
  return traverse(Ray(origin, direction), max_distance, false);
}

bool RayCaster::blocked(const Vector3d& origin, const Vector3d& direction, double max_distance) const {
  return traverse(Ray(origin, direction), max_distance, true).has_value();
}

}  // namespace drape
