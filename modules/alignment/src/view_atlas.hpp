// A mesh from all sides, as polar pictures.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "outline_drawing.hpp"
#include "outline_mesh.hpp"
#include "polar_view.hpp"

namespace drape::alignment {

struct AtlasView {
  Eigen::Matrix3d rotation;  // camera from mesh, before any roll
  double perspective = 0;
  PolarBits bits;
  PolarFrame frame;  // of the unit sphere seen at scale 1: centre and radius of gyration
};

/// `count` directions on a Fibonacci spiral, seen in the middle of the picture with this perspective. Views
/// that show nothing are left out.
[[nodiscard]] std::vector<AtlasView> view_atlas(const OutlineMesh& mesh, int count, double perspective);

/// Draws a view, unrolled, as large as the atlas's pictures are, and gives what it was enlarged by. The
/// sphere's middle is the middle of the picture.
double draw_view(const OutlineMesh& mesh, const AtlasView& view, bool with_rim, OutlineDrawing& drawing,
                 Window& window);

}  // namespace drape::alignment
