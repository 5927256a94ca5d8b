// What is shown where no photo sees the surface.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "drape/texturing/texture_mesh.hpp"

namespace drape::texturing {

/// Linear light of each vertex that lies on a painted face; nothing for the others.
using SeenColors = std::vector<std::optional<Eigen::Vector3f>>;

/// Linear light of every vertex: what is known stays, and over the rest colours go smoothly from what is
/// known to what is known (a harmonic function of the surface: each is the mean of its neighbours). Pieces of
/// the mesh where nothing is known get `elsewhere`.
[[nodiscard]] std::vector<Eigen::Vector3f> harmonic_colors(const TriangleMesh& mesh, const SeenColors& known,
                                                           const Eigen::Vector3f& elsewhere);

/// The material of unseen faces; sets or clears the mesh's vertex colours as it asks. `seen` is needed for
/// inpainting only.
[[nodiscard]] Material unseen_material(TriangleMesh& mesh, Unseen unseen, const SeenColors& seen);

}  // namespace drape::texturing
