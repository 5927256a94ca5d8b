#include "photo_materials.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "edge_splits.hpp"
#include "view_choice.hpp"

namespace drape::texturing {
namespace {

constexpr double straight_px = 0.2;  // how far linear texture coordinates may be from the true projection
constexpr int most_straightenings = 12;
constexpr int filter_margin_px = 8;  // round what is used of a photo, for filters and mip-maps

// The pixels that the triangles use, with room for filters and for what their colours grow from.
PixelBox used_box(const std::vector<PixelTriangle>& triangles, int width, int height, double reach_px) {
  Eigen::AlignedBox2d box;
  for (const PixelTriangle& t : triangles)
    for (const Eigen::Vector2d& p : t) box.extend(p);
  const double margin = filter_margin_px + std::ceil(reach_px);
  return {std::max(0, static_cast<int>(std::floor(box.min().x() - margin))),
          std::max(0, static_cast<int>(std::floor(box.min().y() - margin))),
          std::min(width, static_cast<int>(std::ceil(box.max().x() + margin))),
          std::min(height, static_cast<int>(std::ceil(box.max().y() + margin)))};
}

}  // namespace

void straighten(PaintedFaces& surface, std::vector<int>& chosen, std::span<const PhotoSight> sights) {
  for (int round = 0; round < most_straightenings; ++round) {
    std::vector<EdgeSplit> splits;
    for (std::size_t f = 0; f < chosen.size(); ++f) {
      if (chosen[f] == no_view) continue;
      const Camera& camera = sights[static_cast<std::size_t>(chosen[f])].camera();
      if (camera.projection == Camera::Projection::orthographic) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = surface.mesh.faces[f][k];
        const std::uint32_t b = surface.mesh.faces[f][(k + 1) % 3];
        const Eigen::Vector3d& xa = surface.mesh.vertices[a];
        const Eigen::Vector3d& xb = surface.mesh.vertices[b];
        const Eigen::Vector2d linear = (camera.project(xa).pixel + camera.project(xb).pixel) / 2;
        if ((camera.project((xa + xb) / 2).pixel - linear).norm() > straight_px)
          splits.push_back({std::min(a, b), std::max(a, b), 0.5});
      }
    }
    if (splits.empty()) return;
    cut_edges(surface, chosen, splits);
  }
}

std::vector<PixelTriangle> triangles_in_photo(const TriangleMesh& mesh, std::span<const std::size_t> faces,
                                              const PhotoSight& sight) {
  const Eigen::Vector2d size(sight.camera().width, sight.camera().height);
  std::vector<PixelTriangle> triangles;
  for (const std::size_t f : faces) {
    PixelTriangle t;
    for (std::size_t k = 0; k < 3; ++k)
      t[k] = sight.pixel_of(mesh.vertices[mesh.faces[f][k]]).cwiseMax(Eigen::Vector2d::Zero()).cwiseMin(size);
    triangles.push_back(t);
  }
  return triangles;
}

PhotoMaterial photo_material(const PhotoPixels& photo, const Image8& trusted,
                             const std::vector<PixelTriangle>& triangles, double reach_px) {
  const PixelBox box = used_box(triangles, photo.rgb->width(), photo.rgb->height(), reach_px);
  const Eigen::Vector2d origin(box.left, box.top);
  const Eigen::Vector2d size(box.width(), box.height());
  PhotoMaterial material;
  if (photo.paint_deep) material.deep_image = deep_grown_photo(photo, trusted, box);
  material.image =
      photo.paint_deep ? bytes_from_deep(material.deep_image) : grown_photo(*photo.rgb, trusted, box);
  for (const PixelTriangle& t : triangles) {
    std::array<Eigen::Vector2f, 3> uvs;
    for (std::size_t k = 0; k < 3; ++k) uvs[k] = (t[k] - origin).cwiseQuotient(size).cast<float>();
    material.corner_uvs.push_back(uvs);
  }
  return material;
}

}  // namespace drape::texturing
