#include "drape/report/turntable.hpp"

#include <vector>

#include "drape/rendering/renderer.hpp"
#include "drape/report/contact_sheet.hpp"

namespace drape::report {
namespace {

// Of vertices that a face uses: a stray one would make the picture of the rest small.
std::vector<Camera> cameras_for(const TriangleMesh& mesh, const TurntableStyle& style) {
  return cameras_around(without_unused_vertices(mesh).vertices, style.view);
}

Image8 sheet_of(const std::vector<Image8>& pictures, const TurntableStyle& style) {
  return contact_sheet(pictures, {.cell_width_px = style.view.width_px,
                                  .cell_height_px = style.view.height_px,
                                  .background = style.background});
}

}  // namespace

Image8 turntable(const TriangleMesh& mesh, const TurntableStyle& style) {
  if (mesh.empty()) return {};
  rendering::Renderer renderer(mesh);
  std::vector<Image8> pictures;
  for (const Camera& camera : cameras_for(mesh, style))
    pictures.push_back(renderer.shaded(camera, {.background = style.background, .highlight_filled = true}));
  return sheet_of(pictures, style);
}

Image8 turntable(const TexturedMesh& model, const TurntableStyle& style) {
  if (model.mesh.empty()) return {};
  std::vector<Image8> pictures;
  for (const Camera& camera : cameras_for(model.mesh, style))
    pictures.push_back(rendering::render_textured(model, camera, {.background = style.background}));
  return sheet_of(pictures, style);
}

}  // namespace drape::report
