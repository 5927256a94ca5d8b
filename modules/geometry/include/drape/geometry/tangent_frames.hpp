// The axes that normal maps are written in.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "drape/geometry/textured_mesh.hpp"

namespace drape {

/// glTF's TANGENT (glTF 2.0, section 3.7.2.1), per face and corner: xyz is the direction in which u grows, at
/// right angles to the vertex normal and of unit length; w is +1 or -1, so that w * normal x tangent points
/// to where v becomes less (up in the picture). Mean over the faces round a vertex that have the same texture
/// coordinates and material there. `normals`: per vertex. Where texture coordinates say nothing, any
/// direction along the surface.
[[nodiscard]] std::vector<std::array<Eigen::Vector4f, 3>> corner_tangents(
    const TexturedMesh& model, const std::vector<Eigen::Vector3f>& normals);

}  // namespace drape
