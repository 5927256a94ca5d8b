// Depth maps drawn without OpenGL: nothing to set up, and exact to rounding.
#pragma once

#include "drape/rendering/renderer.hpp"

namespace drape::rendering {

/// What Renderer::depth_map gives, drawn by scan lines in double precision on all threads: for few pictures
/// of a mesh that is not too large for a renderer to be worth its while. Both sides of every face; of faces
/// equally far away, the one that comes first. A pixel centre on the common edge of two faces is covered.
/// Error{input}: a mesh that breaks its promises, a camera of no pixels or of more than 16384 a side.
[[nodiscard]] DepthMap rastered_depth(const TriangleMesh& mesh, const Camera& camera);

}  // namespace drape::rendering
