// Mending a patch where it cuts the surface, and only there.
#pragma once

#include <cstddef>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

struct MendedPatch {
  std::vector<Face> faces;
  std::size_t crossings = 0;  // pairs of faces that cross, of which one is the patch's
};

/// The faces of a patch, which is a disc. Those that cross faces of `around` or one another are cut out with
/// some rings of the patch round them, and what that opens is triangulated anew with the fewest crossings
/// (least_crossing_patch), where that leaves fewer. Cuts with borders longer than that can be given stay as
/// they were. All faces are between vertices of the mesh; no vertex is added or moved, and some of the
/// patch's may be left without a face.
[[nodiscard]] MendedPatch mended_patch(const TriangleMesh& mesh, const std::vector<Face>& patch,
                                       const std::vector<Face>& around);

}  // namespace drape::meshing
