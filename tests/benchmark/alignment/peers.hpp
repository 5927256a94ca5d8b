// Ways that others published to refine a pose, from the same start candidates as the silhouette method.
#pragma once

#include <vector>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::lab {

struct Refined {
  Camera camera;
  double objective = 0;  // more is better
  int evaluations = 0;
};

/// Lensch, Heidrich and Seidel, "A silhouette-based algorithm for texture registration and stitching" (2001):
/// pixels that differ between the two silhouettes are counted, and downhill simplex (Nelder and Mead)
/// minimises their number over rotation, translation and focal length, started again until it gains nothing.
/// On silhouettes of 256 pixels.
[[nodiscard]] Refined refined_by_xor(const TriangleMesh& mesh, const Image8& stencil, const Camera& start);

/// Corsini, Dellepiane, Ponchio and Scopigno, "Image-to-geometry registration: a mutual information method
/// exploiting illumination-related geometric properties" (2009): mutual information between the photo's
/// brightness and the normals of the mesh as the pose shows it (8 x 8 directions, and one value for the
/// background), maximised over the same parameters by downhill simplex. On photos of 256 pixels.
[[nodiscard]] Refined refined_by_mutual_information(const TriangleMesh& mesh, const Image8& photo,
                                                    const Camera& start);

}  // namespace drape::lab
