// What every usable photo sees of a mesh, by cameras that fit it.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/texturing/texture_mesh.hpp"
#include "photo_sight.hpp"

namespace drape::texturing {

/// Of the usable views.
struct Sights {
  std::unique_ptr<RayCaster> full;  // the sights refer to it
  std::vector<std::size_t> views;   // their indices
  std::vector<PhotoSight> sights;
  std::vector<double> poses_px;  // as ViewUse's
  std::vector<double> warps_px;
};

/// Corrects the cameras by the outline (pose_on_outline) and, of several, by the photos' agreement
/// (agreeing_cameras), then shifts what is left of the outline (snapped_outline).
[[nodiscard]] Sights sights_of(const TriangleMesh& simplified, const TriangleMesh& full,
                               std::span<const TextureView> views, const TextureOptions& options,
                               const Progress& progress);

}  // namespace drape::texturing
