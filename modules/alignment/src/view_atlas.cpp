#include "view_atlas.hpp"

#include <cmath>
#include <numbers>

#include "drape/base/parallel.hpp"

namespace drape::alignment {
namespace {

constexpr int window_px = 128;

// Looks along `forward`.
Eigen::Matrix3d looking_along(const Eigen::Vector3d& forward) {
  const Eigen::Vector3d up =
      std::abs(forward.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d rotation;
  rotation.row(0) = forward.cross(up).normalized();
  rotation.row(2) = forward;
  rotation.row(1) = rotation.row(2).cross(rotation.row(0));
  return rotation;
}

Eigen::Vector3d fibonacci_direction(std::size_t i, int count) {
  const double z = 1 - (2 * static_cast<double>(i) + 1) / count;
  const double phi = std::numbers::pi * (3 - std::sqrt(5.0)) * static_cast<double>(i);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace

double draw_view(const OutlineMesh& mesh, const AtlasView& view, bool with_rim, OutlineDrawing& drawing,
                 Window& window) {
  window = {};
  window.width = window.height = window_px;
  window.origin.setConstant(-window_px / 2.0);
  OutlinePose pose;
  pose.rotation = view.rotation;
  pose.perspective = view.perspective;
  // A sphere at distance 1 / p appears 1 / sqrt(1 - p^2) times as large as its middle's disc.
  pose.scale = (window_px / 2.0 - 2) * std::sqrt(1 - view.perspective * view.perspective);
  drawing.draw(mesh, pose, window, with_rim);
  return pose.scale;
}

std::vector<AtlasView> view_atlas(const OutlineMesh& mesh, int count, double perspective) {
  std::vector<AtlasView> views(static_cast<std::size_t>(count));
  parallel_for(views.size(), 16, [&](std::size_t begin, std::size_t end) {
    OutlineDrawing drawing;
    Window window;
    for (std::size_t i = begin; i < end; ++i) {
      AtlasView& view = views[i];
      view.rotation = looking_along(fibonacci_direction(i, count));
      view.perspective = perspective;
      const double scale = draw_view(mesh, view, false, drawing, window);
      const BitImage& stencil = drawing.stencil();
      PolarFrame frame = polar_frame(stencil);
      view.bits = polar_bits(frame, [&](double x, double y) {
        return stencil.at(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)));
      });
      view.frame.center = (frame.center + window.origin) / scale;
      view.frame.radius = frame.radius / scale;
    }
  });
  std::erase_if(views, [](const AtlasView& view) { return !(view.frame.radius > 0); });
  return views;
}

}  // namespace drape::alignment
