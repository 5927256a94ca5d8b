// What is shown where no photo sees the surface.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "drape/texturing/texture_mesh.hpp"
#include "edge_splits.hpp"

namespace drape::texturing {

/// Linear light of each vertex that lies on a painted face; nothing for the others.
using SeenColors = std::vector<std::optional<Eigen::Vector3f>>;

/// Linear light of every vertex: what is known stays, and over the rest colours go smoothly from what is
/// known to what is known (a harmonic function of the surface: each is the mean of its neighbours). Pieces of
/// the mesh where nothing is known get `elsewhere`.
[[nodiscard]] std::vector<Eigen::Vector3f> harmonic_colors(const TriangleMesh& mesh, const SeenColors& known,
                                                           const Eigen::Vector3f& elsewhere);

/// Per face 1 where it is not painted but lies all within `reach` of painted surface, along its edges: the
/// ribbons that guards leave behind outlines and at their rim.
[[nodiscard]] std::vector<std::uint8_t> faces_within_reach(const TriangleMesh& mesh,
                                                           const std::vector<std::uint8_t>& painted,
                                                           double reach);

/// Where to cut edges of unpainted faces that leave the reach of painted surface, so that ribbons end there
/// and not where the last whole face does: faces may be much larger than the reach.
[[nodiscard]] std::vector<EdgeSplit> ends_of_reach(const TriangleMesh& mesh,
                                                   const std::vector<std::uint8_t>& painted, double reach);

/// What vertices of surface without a photo show: nothing if it is all one flat colour.
[[nodiscard]] std::vector<Eigen::Vector3f> unseen_colors(const TriangleMesh& mesh, Unseen unseen,
                                                         const SeenColors& seen);

/// Of surface that nobody saw, as stored.
inline const Eigen::Vector3f neutral_color(0.62F, 0.62F, 0.6F);

}  // namespace drape::texturing
