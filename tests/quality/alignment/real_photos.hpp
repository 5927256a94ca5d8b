// The photos of DRAPE_TEST_DATA with what is known of them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "visual_hull.hpp"

namespace drape::lab {

/// A photo whose camera is known: for judging what was found, never for finding it.
struct PosedPhoto {
  std::string name;
  std::filesystem::path image;
  std::filesystem::path mesh;  // empty: none
  Camera truth;
};

/// Those of photos/poses.json whose name begins with `prefix`, in its order; none without the file.
[[nodiscard]] std::vector<PosedPhoto> posed_photos(const std::string& prefix);

/// Outline of the bright object on black of a dino photo: all above 0.19 of full scale, closed and grown as
/// the photos' publisher tells it (dilated by 10 pixels, eroded by 7), its largest part without holes.
[[nodiscard]] Image8 dino_stencil(const Image8& rgb);

/// The dino carved from these, in the box that its publisher states and a little around it.
[[nodiscard]] TriangleMesh dino_hull(const std::vector<Outline>& outlines);

/// A photo and its hand-made stencil, of segmentation/.
struct MaskedPhoto {
  std::string name;
  Image8 rgb;
  Image8 stencil;
};
[[nodiscard]] std::vector<MaskedPhoto> masked_photos();

}  // namespace drape::lab
