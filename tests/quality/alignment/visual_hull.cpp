#include "visual_hull.hpp"

#include <algorithm>
#include <limits>

#include "drape/metrics/camera_error.hpp"
#include "implicit_shape.hpp"
#include "signed_distance.hpp"

namespace drape::lab {
namespace {

constexpr double millimetres = 1000;

struct View {
  Camera camera;
  ImageF distance_px;  // positive inside
  double focal_px;

  /// Negative where the photo shows background, in metres; nothing to say beyond its border.
  [[nodiscard]] double inside(const Eigen::Vector3d& x) const {
    const Camera::Projected seen = camera.project(x);
    const Eigen::Vector2d at = seen.pixel - Eigen::Vector2d(0.5, 0.5);
    const int u = static_cast<int>(std::floor(at.x()));
    const int v = static_cast<int>(std::floor(at.y()));
    if (u < 0 || v < 0 || u + 1 >= camera.width || v + 1 >= camera.height)
      return std::numeric_limits<double>::max();
    const double s = at.x() - u;
    const double t = at.y() - v;
    const double value = (1 - t) * ((1 - s) * distance_px.at(u, v) + s * distance_px.at(u + 1, v)) +
                         t * ((1 - s) * distance_px.at(u, v + 1) + s * distance_px.at(u + 1, v + 1));
    return value * seen.depth / focal_px;
  }
};

}  // namespace

TriangleMesh visual_hull(const std::vector<Outline>& outlines, const BoundingBox& box, double pitch) {
  std::vector<View> views;
  for (const Outline& outline : outlines)
    views.push_back({outline.camera, signed_distance(outline.stencil), metrics::focal_px(outline.camera)});
  simulation::ImplicitShape shape;
  shape.box = BoundingBox(millimetres * box.min(), millimetres * box.max());
  shape.pitch = millimetres * pitch;
  shape.deviation = shape.pitch / 20;
  shape.distance = [&views, &box](const Eigen::Vector3d& point) {
    const Eigen::Vector3d x = point / millimetres;
    double inside = std::min((x - box.min()).minCoeff(), (box.max() - x).minCoeff());
    for (const View& view : views) inside = std::min(inside, view.inside(x));
    return -millimetres * inside;
  };
  TriangleMesh mesh = simulation::mesh_of(shape, 1);
  for (Eigen::Vector3d& x : mesh.vertices) x /= millimetres;
  return mesh;
}

}  // namespace drape::lab
