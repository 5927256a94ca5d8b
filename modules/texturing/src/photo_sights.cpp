#include "photo_sights.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drape/geometry/bounding_box.hpp"
#include "drape/rendering/renderer.hpp"
#include "outline_pose.hpp"
#include "photo_agreement.hpp"

namespace drape::texturing {
namespace {

constexpr double least_tolerance = 1e-5;  // of the mesh's extent
constexpr double most_pose_erosion_px = 6;
constexpr double same_depth_px = 0.1;  // cameras this close see the same depth

bool same_surface(const TriangleMesh& a, const TriangleMesh& b) {
  return a.faces == b.faces && a.vertices == b.vertices;
}

Image8 stencil_of(const ImageF& depth, const Camera& camera) {
  Image8 stencil(camera.width, camera.height, 1, stencil::background);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const auto reduced = [](int at, int from, int to) {
        return static_cast<int>(static_cast<std::int64_t>(at) * to / from);
      };
      if (std::isfinite(
              depth.at(reduced(x, camera.width, depth.width()), reduced(y, camera.height, depth.height()))))
        stencil.at(x, y) = stencil::object;
    }
  return stencil;
}

// One usable view while its camera is found.
struct Posed {
  std::size_t view;
  OutlinePose pose;
  double moved_px = 0;
  ImageF depth;
  double tolerance = 0;
};

class Poser {
 public:
  Poser(const TriangleMesh& simplified, const TriangleMesh& full, std::span<const TextureView> views,
        const TextureOptions& options)
      : simplified_(simplified),
        full_(full),
        views_(views),
        options_(options),
        box_(bounding_box(full.vertices)),
        full_renderer_(full) {
    if (!same_surface(simplified, full)) simplified_renderer_.emplace(simplified);
  }

  Posed posed(std::size_t view) {
    Posed p{view, pose_on_outline(full_renderer_, views_[view].camera, views_[view].stencil, box_.center(),
                                  options_.pose_max_px)};
    p.moved_px = p.pose.moved_px;
    look(p);
    return p;
  }

  // The photos together; cameras that move are drawn anew.
  void agree(std::vector<Posed>& posed, const Progress& progress) {
    std::vector<AgreementView> together;
    for (const Posed& p : posed)
      together.push_back({views_[p.view].rgb, views_[p.view].stencil, p.pose.camera, p.depth, p.pose.hold});
    const AgreeingCameras agreeing = agreeing_cameras(simplified_, together, options_.pose_max_px, progress);
    for (std::size_t i = 0; i < posed.size(); ++i) {
      if (!(agreeing.moved_px[i] > 0)) continue;
      posed[i].pose.camera = agreeing.cameras[i];
      posed[i].moved_px = std::max(posed[i].moved_px, agreeing.moved_px[i]);
      if (agreeing.moved_px[i] > same_depth_px) look(posed[i]);
    }
  }

 private:
  void look(Posed& p) {
    const Camera camera = depth_camera(p.pose.camera);
    rendering::DepthMap map = full_renderer_.depth_map(camera);
    p.tolerance = least_tolerance * box_.diagonal().norm();
    if (simplified_renderer_)
      p.tolerance = std::max(
          p.tolerance, surface_deviation(simplified_renderer_->depth_map(camera), simplified_, map, camera));
    p.depth = std::move(map.depth);
  }

  const TriangleMesh& simplified_;
  const TriangleMesh& full_;
  std::span<const TextureView> views_;
  const TextureOptions& options_;
  Eigen::AlignedBox3d box_;
  rendering::Renderer full_renderer_;
  std::optional<rendering::Renderer> simplified_renderer_;
};

}  // namespace

Sights sights_of(const TriangleMesh& simplified, const TriangleMesh& full, std::span<const TextureView> views,
                 const TextureOptions& options, const Progress& progress) {
  Sights out;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].usable) out.views.push_back(i);
  if (out.views.empty()) return out;
  Poser poser(simplified, full, views, options);
  std::vector<Posed> posed;
  for (std::size_t i = 0; i < out.views.size(); ++i) {
    progress.update(0.6 * static_cast<double>(i) / static_cast<double>(out.views.size()),
                    "drawing what the photos see");
    posed.push_back(poser.posed(out.views[i]));
  }
  if (posed.size() > 1 && options.pose_max_px > 0) poser.agree(posed, progress.part(0.6, 0.9));
  for (Posed& p : posed) {
    const TextureView& view = views[p.view];
    SnappedOutline snapped;
    if (options.warp_max_px > 0 && !view.stencil.empty())
      snapped = snapped_outline(stencil_of(p.depth, view.camera), view.stencil, options.warp_max_px);
    const double erode_px =
        options.stencil_erode_px + std::min(most_pose_erosion_px, std::max(0.0, view.pose_sigma_px));
    out.poses_px.push_back(p.moved_px);
    out.warps_px.push_back(snapped.largest_px);
    out.sights.emplace_back(
        p.pose.camera, std::move(snapped.warp), std::move(p.depth),
        usable_pixels(view.stencil, view.rgb.width(), view.rgb.height(), erode_px, options.fill_px),
        p.tolerance, options.max_incidence_deg);
  }
  return out;
}

}  // namespace drape::texturing
