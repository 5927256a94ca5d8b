// Photos with their light taken out.
#pragma once

#include <span>
#include <vector>

#include "drape/base/progress.hpp"
#include "drape/geometry/deep_image.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "grown_photo.hpp"
#include "light_fit.hpp"
#include "photo_sight.hpp"

namespace drape::texturing {

struct DelitPhoto {
  Image8 rgb;        // albedo where the photo sees the surface, sRGB-encoded
  Image16 deep_rgb;  // the same in 16 bits, where the photo is painted so
  Image8 trusted;    // as the sight's, but none where there is no surface to know the light of
};

struct Delighting {
  std::vector<DelitPhoto> photos;  // as the sights
  std::vector<PhotoLight> lights;
  AlbedoSpread spread;
};

/// Fits one light per photo (see fitted_lights) and divides each photo by its shading, in linear light. The
/// albedo's common brightness and tint are those of the photos, darkened where bright paint would not fit.
/// `photos[i]`: what sight i looks at. Highlights stay: light is taken for diffuse.
[[nodiscard]] Delighting delit_photos(const TriangleMesh& mesh, std::span<const PhotoSight> sights,
                                      const std::vector<PhotoPixels>& photos, const Progress& progress);

}  // namespace drape::texturing
