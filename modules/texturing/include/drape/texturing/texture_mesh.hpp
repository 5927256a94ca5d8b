// Photos draped over a mesh: direct projection with a hidden-surface test.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/textured_mesh.hpp"

namespace drape::texturing {

enum class Unseen {
  scan_colour,  // the mesh's own colours; neutral if it has none
  neutral       // flat grey
};

struct TextureOptions {
  double max_incidence_deg = 80;
  double stencil_erode_px = 1.5;
  double fill_px = 6;
  double split_px = 1;
  Unseen unseen = Unseen::scan_colour;
};

inline void describe(Binder& b, TextureOptions& o) {
  b.number("max_incidence_deg", o.max_incidence_deg, {1, 89.9},
           "surface that a photo sees more obliquely than this (0: straight on) is not painted from it");
  b.number(
      "stencil_erode_px", o.stencil_erode_px, {0, 1000},
      "photo pixels this close to the stencil's background are not trusted: object colours are grown over "
      "them");
  b.number("fill_px", o.fill_px, {0, 1000},
           "surface that projects up to this far outside the trusted pixels is painted with grown colours; "
           "farther out it counts as unseen");
  b.number("split_px", o.split_px, {0.25, 1000},
           "triangles that a photo sees partly are split until their edges are this short in the photo");
  b.choice("unseen", o.unseen, {{"scan_colour", Unseen::scan_colour}, {"neutral", Unseen::neutral}},
           "how surface that no photo sees is shown; scan_colour: the mesh's own colours, neutral grey if it "
           "has none");
}

/// One photo with its camera. The stencil is the final one: as large as the photo, or empty if every pixel
/// may be used; unknown pixels are not used. Referred to, not copied.
struct TextureView {
  const Image8& rgb;
  Camera camera;  // in the mesh's frame and unit
  const Image8& stencil;
  std::string name;    // of its material; other characters than [A-Za-z0-9_] become _
  bool usable = true;  // false for a rejected photo: it is not draped
};

/// What became of one photo.
struct ViewUse {
  int material = -1;           // of the model; -1 if nothing is painted from it
  double painted_percent = 0;  // of the model's area
  std::string reason;          // why nothing is painted from it; empty if something is
};

struct TextureResult {
  TexturedMesh model;          // one material per photo that paints something, in their order, then "unseen"
  std::vector<ViewUse> views;  // as the views given
  /// Per view, as large as its photo: pixels that are on the model as they were, pixels there that grown
  /// colours replaced in orange, and the rest in dim grey. Empty for a view that is not usable.
  std::vector<Image8> coverage;
  // Percent of the model's area; they add up to 100.
  double seen_percent = 0;    // painted with pixels of a photo
  double filled_percent = 0;  // painted with colours grown past the trusted part of a photo
  double unseen_percent = 0;
  /// Of the photos' pixels under the painted surface: those that the stencils call background (the mesh
  /// reaches over the outline there), and those of them that still show in the materials.
  double overhang_percent = 0;
  double background_texels_percent = 0;
  bool unseen_in_scan_colour = false;
};

/// Every part of the surface that a photo sees gets texture coordinates straight into that photo, by its own
/// camera (thesis, section 4.3); where several see it, the one with the most pixels for its area seen most
/// squarely, neighbours preferring the same photo. Visibility is tested per photo pixel against the depth of
/// `full`, front and back faces alike, holes included; `simplified` is what is painted (it may be `full`).
/// Triangles seen partly are split along the outline of what is seen, on both sides of each edge, so that no
/// cracks open, and until linear texture coordinates follow the perspective within 0.2 px.
///
/// A material's image is a copy of the photo cropped to what is used, with the object's colours grown
/// outwards over everything that the eroded stencil does not trust (pull-push, Gortler et al., SIGGRAPH 1996,
/// in linear light): no filter reaches background. The same bytes for any number of threads.
///
/// Error{input}: a mesh that breaks its promises or has no area; a photo that is no RGB or is not as large as
/// its camera or stencil says. No photo that sees the mesh is no error: all of it is unseen.
[[nodiscard]] TextureResult texture_mesh(const TriangleMesh& simplified, const TriangleMesh& full,
                                         std::span<const TextureView> views, const TextureOptions& options,
                                         const Progress& progress = {});

}  // namespace drape::texturing
