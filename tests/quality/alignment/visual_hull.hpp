// A mesh from outlines: where an object can be, given what it covers in photos of known cameras.
#pragma once

#include <vector>

#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::lab {

struct Outline {
  Camera camera;
  Image8 stencil;
};

/// The visual hull (Laurentini 1994) within `box`, on a lattice of this pitch; beyond a photo's border that
/// photo says nothing. All in metres.
[[nodiscard]] TriangleMesh visual_hull(const std::vector<Outline>& outlines, const BoundingBox& box,
                                       double pitch);

}  // namespace drape::lab
