// The shape that simplification took away, as pictures.
#pragma once

#include "drape/base/progress.hpp"
#include "drape/geometry/textured_mesh.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::texturing {

/// The model with a normal map for each material that has an image (Cohen, Olano, Manocha,
/// "Appearance-preserving simplification", 1998): each texel has the smoothed normal of `full` at its point
/// nearest to the texel's, in the axes of corner_tangents() about the model's vertex normals. At most
/// `most_side_px` a side, of the image's shape; texels that no face covers go on from those that one does.
/// Where `full` has nothing near that looks the same way, the map changes nothing. Error{input} if a mesh
/// breaks its promises or has no area.
[[nodiscard]] TexturedMesh with_normal_maps(TexturedMesh model, const TriangleMesh& full, int most_side_px,
                                            const Progress& progress = {});

}  // namespace drape::texturing
