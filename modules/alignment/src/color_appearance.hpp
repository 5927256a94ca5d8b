// The colours' second cue: whether what is inside the outline looks like the mesh in that pose.
#pragma once

#include <functional>
#include <vector>

#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "drape/rendering/renderer.hpp"
#include "photo_plane.hpp"
#include "pose_refinement.hpp"

namespace drape::alignment {

/// Share of the variance of the photo's colours where `camera` sees the mesh that light on it explains: each
/// channel is fitted by a constant and the nine spherical harmonics of second order of the normals (Basri and
/// Jacobs 2003), times the mesh's own colour where it has colours. 0..1; 0 where too little is seen. `camera`
/// is of the ideal plane.
[[nodiscard]] double explained_colors(const TriangleMesh& mesh, rendering::Renderer& renderer,
                                      const Image8& rgb, const PhotoPlane& plane, const Camera& camera);

/// Ranks poses by their outlines and by `explained`, the share of each: of poses in one place, which show the
/// same pixels, by how much more is left unexplained (root mean square) than by the best of them. Between
/// places the shares tell nothing, as other paint is explained better or worse. Best first.
void rank_by_appearance(std::vector<RefinedPose>& poses,
                        const std::function<double(const OutlinePose&)>& explained);

}  // namespace drape::alignment
