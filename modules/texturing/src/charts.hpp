// Pieces of the surface that lie side by side in one photo.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "painted_faces.hpp"

namespace drape::texturing {

using FaceTexels = std::array<Eigen::Vector2d, 3>;

/// Connected faces of one photo, laid out as that photo shows them: no two of them share a texel.
struct Chart {
  int view = 0;
  double scale = 1;  // texels per pixel of the photo
  std::vector<std::uint32_t> faces;
  std::vector<FaceTexels> texels;  // per face its corners, padding included, from the chart's own corner
  int width = 0;                   // whole texels, with the padding on both sides
  int height = 0;
};

/// `scale`: texels per pixel of the photo; charts that would be larger than `most_side` become smaller by
/// themselves.
[[nodiscard]] std::vector<Chart> charts_of(const PaintedFaces& surface, std::span<const int> chosen,
                                           std::span<const PhotoSight> sights, double scale, int padding,
                                           int most_side);

}  // namespace drape::texturing
