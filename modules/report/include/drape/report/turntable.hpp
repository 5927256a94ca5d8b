// A model from several sides.
#pragma once

#include <Eigen/Core>

#include "drape/geometry/image.hpp"
#include "drape/geometry/textured_mesh.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/report/views.hpp"

namespace drape::report {

struct TurntableStyle {
  ViewStyle view;
  Eigen::Vector3f background = Eigen::Vector3f(0.925F, 0.933F, 0.945F);  // sRGB, 0..1
};

/// RGB contact sheet of a shaded mesh; faces that hole filling made stand out in another colour. Empty for a
/// mesh without faces.
[[nodiscard]] Image8 turntable(const TriangleMesh& mesh, const TurntableStyle& style = {});

/// The same of a textured model, in the colours of its textures.
[[nodiscard]] Image8 turntable(const TexturedMesh& model, const TurntableStyle& style = {});

}  // namespace drape::report
