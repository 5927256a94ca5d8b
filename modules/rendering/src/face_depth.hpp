// Depths from face numbers, in double precision.
#pragma once

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::rendering {

/// Where each pixel centre's ray meets the plane of its face, along the optical axis: free of the depth
/// plane's rounding. Of a face seen edge-on the depth is kept within that of its corners. +infinity where the
/// face is -1.
[[nodiscard]] ImageF depth_of_faces(const TriangleMesh& mesh, const Camera& camera,
                                    const Image<std::int32_t>& faces);

}  // namespace drape::rendering
