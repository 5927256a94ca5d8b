// A mesh from all sides, as polar pictures.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "outline_mesh.hpp"
#include "polar_view.hpp"

namespace drape::alignment {

struct AtlasView {
  Eigen::Matrix3d rotation;  // camera from mesh, before any roll
  PolarBits bits;
  PolarFrame frame;  // of the unit sphere seen at scale 1: centre and radius of gyration
};

/// `count` directions on a Fibonacci spiral, seen in the middle of the picture with this perspective. Views
/// that show nothing are left out.
[[nodiscard]] std::vector<AtlasView> view_atlas(const OutlineMesh& mesh, int count, double perspective);

}  // namespace drape::alignment
