#include "photo_sights.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drape/base/parallel.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/rendering/depth_raster.hpp"
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
  const auto reduced = [](int at, int from, int to) {
    return static_cast<int>(static_cast<std::int64_t>(at) * to / from);
  };
  std::vector<int> columns;
  for (int x = 0; x < camera.width; ++x) columns.push_back(reduced(x, camera.width, depth.width()));
  for (int y = 0; y < camera.height; ++y) {
    const std::span<const float> row = depth.row(reduced(y, camera.height, depth.height()));
    const std::span<std::uint8_t> out = stencil.row(y);
    for (std::size_t x = 0; x < columns.size(); ++x)
      if (std::isfinite(row[static_cast<std::size_t>(columns[x])])) out[x] = stencil::object;
  }
  return stencil;
}

// One usable view while its camera is found.
struct Posed {
  std::size_t view = 0;
  OutlinePose pose;
  double moved_px = 0;
  double agreed_px = 0;  // moved by the photos' agreement
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
        same_(same_surface(simplified, full)) {}

  [[nodiscard]] Posed posed(std::size_t view) const {
    Posed p{view, pose_on_outline(full_, views_[view].camera, views_[view].stencil, box_.center(),
                                  options_.pose_max_px)};
    p.moved_px = p.pose.moved_px;
    look(p);
    return p;
  }

  /// What the camera sees, as it is now.
  void look(Posed& p) const {
    const Camera camera = depth_camera(p.pose.camera);
    rendering::DepthMap map = p.pose.map ? std::move(*p.pose.map) : rendering::rastered_depth(full_, camera);
    p.pose.map.reset();
    p.tolerance = least_tolerance * box_.diagonal().norm();
    if (!same_)
      p.tolerance = std::max(p.tolerance, surface_deviation(rendering::rastered_depth(simplified_, camera),
                                                            simplified_, map, camera));
    p.depth = std::move(map.depth);
  }

 private:
  const TriangleMesh& simplified_;
  const TriangleMesh& full_;
  std::span<const TextureView> views_;
  const TextureOptions& options_;
  Eigen::AlignedBox3d box_;
  bool same_;
};

// The photos together; cameras that move are drawn anew.
void agree(const Poser& poser, const TriangleMesh& simplified, std::span<const TextureView> views,
           const TextureOptions& options, std::vector<Posed>& posed, const Progress& progress) {
  std::vector<AgreementView> together;
  for (const Posed& p : posed)
    together.push_back({views[p.view].rgb, views[p.view].stencil, p.pose.camera, p.depth, p.pose.hold});
  const AgreeingCameras agreeing = agreeing_cameras(simplified, together, options.pose_max_px, progress);
  for (std::size_t i = 0; i < posed.size(); ++i) {
    if (!(agreeing.moved_px[i] > 0)) continue;
    posed[i].pose.camera = agreeing.cameras[i];
    posed[i].agreed_px = agreeing.moved_px[i];
    posed[i].moved_px = std::max(posed[i].moved_px, agreeing.moved_px[i]);
    if (agreeing.moved_px[i] > same_depth_px) poser.look(posed[i]);
  }
}

PhotoSight sight_of(Posed& p, std::span<const TextureView> views, const TextureOptions& options,
                    const RayCaster& full, double& warp_px) {
  const TextureView& view = views[p.view];
  SnappedOutline snapped;
  const bool close = p.pose.miss_px < negligible_miss_px && p.agreed_px == 0;
  if (options.warp_max_px > 0 && !view.stencil.empty() && !close)
    snapped = snapped_outline(stencil_of(p.depth, view.camera), view.stencil, options.warp_max_px);
  const double erode_px =
      options.stencil_erode_px + std::min(most_pose_erosion_px, std::max(0.0, view.pose_sigma_px));
  warp_px = snapped.largest_px;
  return {p.pose.camera,
          std::move(snapped.warp),
          std::move(p.depth),
          usable_pixels(view.stencil, view.rgb.width(), view.rgb.height(), erode_px, options.fill_px),
          p.tolerance,
          options.max_incidence_deg,
          full};
}

}  // namespace

Sights sights_of(const TriangleMesh& simplified, const TriangleMesh& full, std::span<const TextureView> views,
                 const TextureOptions& options, const Progress& progress) {
  Sights out;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].usable) out.views.push_back(i);
  if (out.views.empty()) return out;
  progress.update(0, "drawing what the photos see");
  std::vector<Posed> posed(out.views.size());
  const Poser poser(simplified, full, views, options);
  // One thread makes ready for rays meanwhile.
  parallel_for(posed.size() + 1, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (i == 0)
        out.full = std::make_unique<RayCaster>(full);
      else
        posed[i - 1] = poser.posed(out.views[i - 1]);
  });
  if (posed.size() > 1 && options.pose_max_px > 0)
    agree(poser, simplified, views, options, posed, progress.part(0.6, 0.8));
  progress.update(0.8, "laying the outlines on each other");
  std::vector<std::optional<PhotoSight>> sights(posed.size());
  out.warps_px.resize(posed.size());
  parallel_for(posed.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      sights[i] = sight_of(posed[i], views, options, *out.full, out.warps_px[i]);
  });
  for (std::size_t i = 0; i < posed.size(); ++i) {
    out.poses_px.push_back(posed[i].moved_px);
    out.sights.push_back(std::move(*sights[i]));
  }
  return out;
}

}  // namespace drape::texturing
