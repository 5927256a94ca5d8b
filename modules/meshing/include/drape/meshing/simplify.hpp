// Fewer triangles for the same shape.
#pragma once

#include <cstddef>

#include "drape/geometry/textured_mesh.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::meshing {

/// Both may hold; without either the mesh stays as it is.
struct SimplifyLimits {
  std::size_t triangles = 0;  // no fewer than these are aimed at; 0: any number
  double error = 0;           // the most that the surface may move, in the mesh's unit; 0: anything
};

/// At most `triangles` faces, or as few as can be reached within the error and without changing the topology,
/// by quadric edge collapse (Garland and Heckbert 1997, meshoptimizer; the error is estimated from the
/// quadrics, on the safe side). The vertices are some of the mesh's own, with their bits and attributes;
/// normals are computed anew where the mesh has them; a face is `filled` where the nearest face of the mesh
/// is. The same mesh if it has no more faces than asked for. Error{input} if it breaks its promises
/// (problem_of).
[[nodiscard]] TriangleMesh simplified(const TriangleMesh& mesh, const SimplifyLimits& limits);

/// About `triangles` faces of a textured model by the same edge collapse, its seams and the borders between
/// its materials kept together; more where these do not allow so few. Faces keep their materials, corners
/// their texture coordinates; `filled` is left out. The same model if it has no more faces, or for 0
/// triangles.
[[nodiscard]] TexturedMesh simplified(const TexturedMesh& model, std::size_t triangles);

}  // namespace drape::meshing
