#include "drape/rendering/depth_raster.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "clip_matrix.hpp"
#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "windows.hpp"

namespace drape::rendering {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int band_rows = 32;
constexpr std::size_t vertices_per_chunk = 8192;

// A triangle, or what the nearest plane leaves of one: a convex polygon in pixels.
struct Outline {
  std::array<Vector2d, 4> corners = {Vector2d::Zero(), Vector2d::Zero(), Vector2d::Zero(), Vector2d::Zero()};
  std::size_t count = 0;
  void add(const Vector2d& corner) { corners[count++] = corner; }
};

// An edge from its upper end down. Both faces at an edge reckon with the same numbers, whichever way they
// run along it: no pixel between them is left out.
struct Edge {
  Vector2d top;
  Vector2d bottom;
  double slope;

  Edge(const Vector2d& a, const Vector2d& b) : top(a), bottom(b), slope(0) {
    if (std::pair(b.y(), b.x()) < std::pair(a.y(), a.x())) std::swap(top, bottom);
    if (top.y() < bottom.y()) slope = (bottom.x() - top.x()) / (bottom.y() - top.y());
  }
  [[nodiscard]] double at(double y) const {
    if (y == top.y()) return top.x();
    if (y == bottom.y()) return bottom.x();
    return std::clamp(top.x() + (y - top.y()) * slope, std::min(top.x(), bottom.x()),
                      std::max(top.x(), bottom.x()));
  }
};

// Depth over the picture: of a perspective camera its inverse is linear in the pixel, of an orthographic one
// it is itself. Held within that of the corners, for faces seen edge on.
struct DepthPlane {
  bool inverse;
  Vector3d by_pixel;  // times (x, y, 1)
  double least;
  double most;

  [[nodiscard]] float at(double x, double y) const {
    const double value = by_pixel.x() * x + by_pixel.y() * y + by_pixel.z();
    const double depth = inverse ? 1 / value : value;
    if (!std::isfinite(depth)) return static_cast<float>(least);
    return static_cast<float>(std::clamp(depth, least, most));
  }
};

class Raster {
 public:
  Raster(const TriangleMesh& mesh, const Camera& camera, double nearest)
      : mesh_(mesh),
        camera_(camera),
        perspective_(camera.projection == Camera::Projection::perspective),
        nearest_(nearest),
        ray_of_pixel_(camera.K.inverse()) {
    in_camera_.resize(mesh.vertices.size());
    pixels_.resize(mesh.vertices.size());
    parallel_for(mesh.vertices.size(), vertices_per_chunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        in_camera_[v] = camera.camera_from_world * mesh.vertices[v];
        pixels_[v] = pixel_of(in_camera_[v]);
      }
    });
    sort_into_bands();
  }

  DepthMap drawn() const {
    DepthMap map{ImageF(camera_.width, camera_.height, 1, std::numeric_limits<float>::infinity()),
                 Image<std::int32_t>(camera_.width, camera_.height, 1, DepthMap::no_face)};
    parallel_for(bands_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        for (const std::uint32_t f : bands_[b]) draw(f, static_cast<int>(b) * band_rows, map);
    });
    return map;
  }

 private:
  [[nodiscard]] Vector2d pixel_of(const Vector3d& x) const {
    const Vector3d plane = perspective_ ? Vector3d(x / x.z()) : Vector3d(x.x(), x.y(), 1);
    return (camera_.K * Vector3d(plane.x(), plane.y(), 1)).head<2>();
  }

  // Faces behind the nearest plane have no corners.
  [[nodiscard]] Outline outline_of(std::uint32_t face) const {
    Outline outline;
    const Face& f = mesh_.faces[face];
    const auto in_front = [&](std::uint32_t v) { return !perspective_ || in_camera_[v].z() >= nearest_; };
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = f[k];
      const std::uint32_t b = f[(k + 1) % 3];
      if (in_front(a)) outline.add(pixels_[a]);
      if (in_front(a) == in_front(b)) continue;
      const double share = (nearest_ - in_camera_[a].z()) / (in_camera_[b].z() - in_camera_[a].z());
      outline.add(pixel_of(in_camera_[a] + share * (in_camera_[b] - in_camera_[a])));
    }
    return outline;
  }

  void sort_into_bands() {
    bands_.resize(static_cast<std::size_t>((camera_.height + band_rows - 1) / band_rows));
    for (std::uint32_t f = 0; f < mesh_.faces.size(); ++f) {
      const Outline outline = outline_of(f);
      if (outline.count == 0) continue;
      double top = outline.corners[0].y();
      double bottom = top;
      double left = outline.corners[0].x();
      double right = left;
      for (std::size_t k = 1; k < outline.count; ++k) {
        top = std::min(top, outline.corners[k].y());
        bottom = std::max(bottom, outline.corners[k].y());
        left = std::min(left, outline.corners[k].x());
        right = std::max(right, outline.corners[k].x());
      }
      if (!(bottom >= 0 && top <= camera_.height && right >= 0 && left <= camera_.width)) continue;
      const auto band = [&](double y) {
        return static_cast<std::size_t>(std::clamp(y, 0.0, camera_.height - 1.0)) / band_rows;
      };
      for (std::size_t b = band(top - 1); b <= band(bottom + 1); ++b) bands_[b].push_back(f);
    }
  }

  [[nodiscard]] DepthPlane plane_of(std::uint32_t face) const {
    const Face& f = mesh_.faces[face];
    const Vector3d& a = in_camera_[f[0]];
    const Vector3d& b = in_camera_[f[1]];
    const Vector3d& c = in_camera_[f[2]];
    const Vector3d normal = (b - a).cross(c - a);
    DepthPlane plane{perspective_, {}, std::min({a.z(), b.z(), c.z()}), std::max({a.z(), b.z(), c.z()})};
    if (perspective_) {
      // normal . (depth ray) = normal . a
      plane.by_pixel = ray_of_pixel_.transpose() * normal / normal.dot(a);
      plane.least = std::max(plane.least, nearest_);
    } else {
      // normal . (ray.x, ray.y, depth) = normal . a
      const Vector3d by_ray(-normal.x() / normal.z(), -normal.y() / normal.z(), normal.dot(a) / normal.z());
      plane.by_pixel = ray_of_pixel_.transpose() * by_ray;
    }
    return plane;
  }

  void draw(std::uint32_t face, int first_row, DepthMap& map) const {
    const Outline outline = outline_of(face);
    std::array<Edge, 4> edges = {Edge(outline.corners[0], outline.corners[1]),
                                 Edge(outline.corners[1], outline.corners[2]),
                                 Edge(outline.corners[2], outline.corners[outline.count == 4 ? 3 : 0]),
                                 Edge(outline.corners[3], outline.corners[0])};
    double top = edges[0].top.y();
    double bottom = edges[0].bottom.y();
    for (std::size_t k = 1; k < outline.count; ++k) {
      top = std::min(top, edges[k].top.y());
      bottom = std::max(bottom, edges[k].bottom.y());
    }
    const auto clamped = [](double value, double least, double most) {
      return static_cast<int>(std::clamp(value, least, most));
    };
    const int rows = std::min(first_row + band_rows, camera_.height);
    const int from_row = clamped(std::ceil(top - 0.5), first_row, rows);
    const int to_row = clamped(std::floor(bottom - 0.5), first_row - 1, rows - 1);
    if (from_row > to_row) return;
    const DepthPlane plane = plane_of(face);
    for (int y = from_row; y <= to_row; ++y) {
      const double middle = y + 0.5;
      double left = std::numeric_limits<double>::infinity();
      double right = -left;
      for (std::size_t k = 0; k < outline.count; ++k) {
        const Edge& e = edges[k];
        if (!(e.top.y() <= middle && middle <= e.bottom.y()) || e.top.y() == e.bottom.y()) continue;
        const double x = e.at(middle);
        left = std::min(left, x);
        right = std::max(right, x);
      }
      if (!(left <= right)) continue;
      const int from = clamped(std::ceil(left - 0.5), 0, camera_.width);
      const int to = clamped(std::floor(right - 0.5), -1, camera_.width - 1);
      for (int x = from; x <= to; ++x) {
        const float depth = plane.at(x + 0.5, middle);
        float& nearest = map.depth.at(x, y);
        if (!(depth < nearest)) continue;
        nearest = depth;
        map.faces.at(x, y) = static_cast<std::int32_t>(face);
      }
    }
  }

  const TriangleMesh& mesh_;
  const Camera& camera_;
  bool perspective_;
  double nearest_;
  Eigen::Matrix3d ray_of_pixel_;
  std::vector<Vector3d> in_camera_;
  std::vector<Vector2d> pixels_;
  std::vector<std::vector<std::uint32_t>> bands_;  // faces that may reach into each, in their order
};

}  // namespace

DepthMap rastered_depth(const TriangleMesh& mesh, const Camera& camera) {
  const std::string problem = problem_of(mesh);
  if (!problem.empty()) throw input_error("the mesh cannot be drawn: {}", problem);
  check_size(camera);
  const std::optional<DepthRange> range = depth_range(camera, bounding_box(mesh.vertices));
  if (!range)
    return {ImageF(camera.width, camera.height, 1, std::numeric_limits<float>::infinity()),
            Image<std::int32_t>(camera.width, camera.height, 1, DepthMap::no_face)};
  return Raster(mesh, camera, range->nearest).drawn();
}

}  // namespace drape::rendering
