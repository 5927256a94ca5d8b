// A textured model under a light of one's choice.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/textured_mesh.hpp"

namespace drape::rendering {

struct RelitStyle {
  Eigen::Vector3d towards_light = Eigen::Vector3d(-0.5, -0.6, 0.6);  // in the model's frame; any length
  double intensity = 1;     // of the lamp: at 1, white that faces it is shown as white
  double ambient = 0.15;    // light from all round, in the same measure
  double softness_deg = 1;  // the lamp's radius as seen from the model: 0 casts hard shadows
  Eigen::Vector3f background = Eigen::Vector3f(1, 1, 1);  // sRGB
  int samples_per_side = 2;
  int shadow_map_px = 1024;  // a side: finer ones cast finer shadows
};

/// RGB picture: the materials' colours are taken for the paint of a matt surface (Lambert's law), shadows are
/// cast (see ShadowMap), normal maps bend the normals. Both sides of a face are lit alike. Where light is too
/// bright to be shown it is cut off. Error{input} for a model that cannot be drawn or a light from nowhere.
[[nodiscard]] Image8 render_relit(const TexturedMesh& model, const Camera& camera,
                                  const RelitStyle& style = {});

}  // namespace drape::rendering
