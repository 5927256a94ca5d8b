// What the surface of a field is better off without.
#pragma once

#include "cleaning.hpp"

namespace drape::meshing {

/// The same as without_touching_fans, for a mesh of marching cubes, where only vertices on the border can be
/// such: several times faster. Vertices stay, faces go.
[[nodiscard]] Cleaned without_touching_border_fans(TriangleMesh mesh);

/// Without pieces that hold less than `percent` of all faces; the largest always stays. Pieces hang together
/// by vertices. `removed` counts pieces. Vertices stay.
[[nodiscard]] Cleaned without_small_pieces(TriangleMesh mesh, double percent);

}  // namespace drape::meshing
