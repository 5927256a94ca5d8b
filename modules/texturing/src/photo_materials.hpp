// Photos as materials: texture coordinates straight into each.
#pragma once

#include <span>
#include <vector>

#include "coverage_picture.hpp"
#include "drape/geometry/textured_mesh.hpp"
#include "grown_photo.hpp"
#include "painted_faces.hpp"

namespace drape::texturing {

/// Halves edges of the faces that views paint until the middle of each, in its photo, lies where linear
/// texture coordinates put it. `chosen` follows the faces.
void straighten(PaintedFaces& surface, std::vector<int>& chosen, std::span<const PhotoSight> sights);

/// Corners of faces in a photo, within its borders.
[[nodiscard]] std::vector<PixelTriangle> triangles_in_photo(const TriangleMesh& mesh,
                                                            std::span<const std::size_t> faces,
                                                            const PhotoSight& sight);

struct PhotoMaterial {
  Image8 image;                                            // what is used of the photo
  Image16 deep_image;                                      // the same, where it is painted in 16 bits
  std::vector<std::array<Eigen::Vector2f, 3>> corner_uvs;  // per triangle
};
/// A copy of the photo cropped to what the triangles use and filters reach, with the object's colours grown
/// over what is not fully trusted from up to `reach_px` away.
[[nodiscard]] PhotoMaterial photo_material(const PhotoPixels& photo, const Image8& trusted,
                                           const std::vector<PixelTriangle>& triangles, double reach_px);

}  // namespace drape::texturing
