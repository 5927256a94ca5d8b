// Photos draped over a mesh: straight into the photo, or blended on an atlas of their own.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/deep_image.hpp"
#include "drape/geometry/textured_mesh.hpp"

namespace drape::texturing {

enum class TextureMode {
  automatic,  // atlas for more than one usable photo
  project,    // texture coordinates straight into each photo
  atlas       // charts of all photos, blended and levelled, on square pages
};

enum class Unseen {
  scan_colour,  // the mesh's own colours; neutral if it has none
  intensity,    // the scan's intensities as grey; neutral if it has none
  inpaint,      // colours go on smoothly over the surface from what was seen: invented
  neutral       // flat grey
};

enum class ColorBits { eight, sixteen };

struct TextureOptions {
  TextureMode mode = TextureMode::automatic;
  int atlas_size_px = 4096;
  ColorBits color_bits = ColorBits::eight;
  bool level_seams = true;
  double max_incidence_deg = 88;
  double stencil_erode_px = 1.5;
  double fill_px = 6;
  double pose_max_px = 12;
  double warp_max_px = 4;
  double split_px = 1;
  Unseen unseen = Unseen::scan_colour;
  bool delight = false;
};

inline void describe(Binder& b, TextureOptions& o) {
  b.choice(
      "mode", o.mode,
      {{"auto", TextureMode::automatic}, {"project", TextureMode::project}, {"atlas", TextureMode::atlas}},
      "project: texture coordinates straight into each photo; atlas: all photos blended on square pages; "
      "auto: atlas for more than one photo");
  b.number("atlas_size_px", o.atlas_size_px, {64, 16384},
           "longest side of an atlas page; what does not fit goes on further pages");
  b.choice("color_bits", o.color_bits, {{"8", ColorBits::eight}, {"16", ColorBits::sixteen}},
           "of a texel, for each of red, green and blue; 16: what photos of 16 bits show is kept and blended "
           "in full, and OBJ and PLY get TIFF pictures; a GLB cannot hold more than 8");
  b.flag("level_seams", o.level_seams,
         "atlas: photos' exposures are matched and their colours levelled across seams");
  b.number("max_incidence_deg", o.max_incidence_deg, {1, 89.9},
           "surface that a photo sees more obliquely than this (0: straight on) is not painted from it");
  b.number(
      "stencil_erode_px", o.stencil_erode_px, {0, 1000},
      "photo pixels this close to the stencil's background are not trusted: object colours are grown over "
      "them");
  b.number(
      "fill_px", o.fill_px, {0, 1000},
      "surface up to this far outside the trusted pixels, or beside painted surface, gets colours grown from "
      "there; farther off it counts as unseen");
  b.number(
      "pose_max_px", o.pose_max_px, {0, 1000},
      "cameras are corrected until the model's outline lies on the photo's and several photos show the same "
      "colours at the same places, by a shift of at most this much; 0: not at all");
  b.number(
      "warp_max_px", o.warp_max_px, {0, 100},
      "what is left between the outlines is taken out by a smooth shift of at most this much; 0: not at all");
  b.number("split_px", o.split_px, {0.25, 1000},
           "triangles that a photo sees partly are split until their edges are this short in the photo");
  b.choice("unseen", o.unseen,
           {{"scan_colour", Unseen::scan_colour},
            {"intensity", Unseen::intensity},
            {"inpaint", Unseen::inpaint},
            {"neutral", Unseen::neutral}},
           "how surface that no photo sees is shown; scan_colour, intensity: as the scanner saw it, neutral "
           "grey if it did not; inpaint: with colours that go on smoothly from what was seen");
  b.flag("delight", o.delight,
         "estimate each photo's light and paint the model a second time without it: the albedo, for new "
         "light");
}

/// One photo with its camera. The stencil is the final one: as large as the photo, or empty if every pixel
/// may be used; unknown pixels are not used. Referred to, not copied.
struct TextureView {
  const Image8& rgb;
  Camera camera;  // in the mesh's frame and unit
  const Image8& stencil;
  std::string name;    // of its material; other characters than [A-Za-z0-9_] become _
  bool usable = true;  // false for a rejected photo: it is not draped
  /// How uncertain the camera makes the place of the outline: so much more of the stencil is eroded (6 px at
  /// the most).
  double pose_sigma_px = 0;
  /// The photo in 16 bits, for ColorBits::sixteen; null or empty: it has none, and `rgb` serves.
  const Image16* deep_rgb = nullptr;
};

/// What became of one photo.
struct ViewUse {
  int material = -1;           // of the model; -1 if nothing is painted from it, or on an atlas
  double painted_percent = 0;  // of the model's area
  double pose_px = 0;          // how far the correction of its camera shifted the outline or the surface
  double warp_px = 0;          // the most that its outline was shifted by
  Camera camera;               // that it was draped with: the given one, corrected; without the warp
  std::string reason;          // why nothing is painted from it; empty if something is
};

struct TextureResult {
  /// Materials: one per photo that paints something, in their order, or one per page of the atlas; then
  /// "grown" for ribbons of up to fill_px beside painted surface that go on in its colours (vertex colours),
  /// and "unseen" for the rest, if there is such surface.
  TexturedMesh model;
  std::vector<ViewUse> views;  // as the views given
  /// Per view, as large as its photo: pixels that are on the model as they were, pixels there that grown
  /// colours replaced in orange, and the rest in dim grey. Empty for a view that is not usable.
  std::vector<Image8> coverage;
  /// Per page of the atlas: one colour per photo, orange where colours were grown, black where nothing is.
  std::vector<Image8> atlas_coverage;
  double texels_per_pixel = 1;    // of the photos: under 1 only if an atlas had to be made smaller
  double atlas_used_percent = 0;  // of the pages, by charts
  // Percent of the model's area; they add up to 100.
  double seen_percent = 0;    // painted with pixels of a photo
  double filled_percent = 0;  // in colours grown past the trusted part of a photo
  double unseen_percent = 0;
  /// Of the photos' pixels under the painted surface: those that the stencils call background (the mesh
  /// reaches over the outline there), and those of them that still show in the materials.
  double overhang_percent = 0;
  double background_texels_percent = 0;
  bool unseen_in_scan_colour = false;
  /// With TextureOptions::delight: the model once more, with the same mesh and texture coordinates, in the
  /// colours of its paint; materials "..._color" are called "..._albedo".
  std::optional<TexturedMesh> albedo;
  /// Where two photos see the same surface: the median difference of their log colours, their exposures
  /// matched, before and after the light was taken out. 0 without such places.
  double log_spread_before = 0;
  double log_spread_after = 0;
  std::size_t lamps = 0;  // found, over all photos
};

/// Every part of the surface that a photo sees gets texture coordinates straight into that photo, by its own
/// camera (thesis, section 4.3), give or take a smooth warp that lays the model's outline on the photo's;
/// where several see it, the one with the most pixels for its area seen most squarely, seams costing by their
/// length and by how much the photos differ there; what most photos contradict is not used. Visibility is
/// tested per photo pixel against the depth of `full`, front and back faces alike, holes included;
/// `simplified` is what is painted (it may be `full`). Triangles seen partly are split along the outline of
/// what is seen, on both sides of each edge, so that no cracks open, and until linear texture coordinates
/// follow the perspective within 0.2 px.
///
/// A material's image is a copy of the photo cropped to what is used, with the object's colours grown
/// outwards over everything that the eroded stencil does not trust (pull-push, Gortler et al., SIGGRAPH 1996,
/// in linear light): no filter reaches background. The same bytes for any number of threads.
///
/// On an atlas, charts lie as their photos show them, photos go over into each other along seams, and their
/// colours are corrected smoothly so that they agree (see levelling_gains, blend_weights).
///
/// Error{input}: a mesh that breaks its promises or has no area; a photo that is no RGB or is not as large as
/// its camera or stencil says. No photo that sees the mesh is no error: all of it is unseen.
[[nodiscard]] TextureResult texture_mesh(const TriangleMesh& simplified, const TriangleMesh& full,
                                         std::span<const TextureView> views, const TextureOptions& options,
                                         const Progress& progress = {});

}  // namespace drape::texturing
