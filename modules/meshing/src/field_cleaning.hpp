// What the surface of a field is better off without.
#pragma once

#include "cleaning.hpp"

namespace drape::meshing {

/// The same as without_touching_fans, for a mesh of marching cubes, where only vertices on the border can be
/// such: several times faster. Vertices stay, faces go.
[[nodiscard]] Cleaned without_touching_border_fans(TriangleMesh mesh);

/// Without the faces at border vertices where two of them look away from each other, by more than 120
/// degrees: both walls of a gap narrower than a voxel, which end in the middle of it. No patch could close a
/// hole there without cutting them. One round: the rim of a sheet must not be unzipped. Vertices stay, faces
/// go; `removed` counts vertices.
[[nodiscard]] Cleaned without_folded_border(TriangleMesh mesh);

/// Without pieces that hold less than `percent` of all faces; the largest always stays. Pieces hang together
/// by vertices. `removed` counts pieces. Vertices stay.
[[nodiscard]] Cleaned without_small_pieces(TriangleMesh mesh, double percent);

}  // namespace drape::meshing
