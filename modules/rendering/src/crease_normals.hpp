// Vertex normals that are smooth over a surface and broken at its creases.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "drape/geometry/triangle_mesh.hpp"

namespace drape::rendering {

/// The mesh's vertices, repeated where faces meet at a crease or where a filled face meets one that is not.
struct SplitVertices {
  std::vector<std::uint32_t> sources;    // which vertex of the mesh each one is
  std::vector<Eigen::Vector3f> normals;  // unit length; zero where no face has area
  std::vector<std::uint8_t> filled;      // 1 if its faces are filled ones
  std::vector<Face> faces;               // the mesh's faces, in order, with the new indices
};

/// Faces round a vertex share a normal (area-weighted) unless the angle between theirs and the first's of the
/// group exceeds the crease angle; which way round a face is does not matter for it. A mesh with normals of
/// its own keeps them.
[[nodiscard]] SplitVertices split_at_creases(const TriangleMesh& mesh);

}  // namespace drape::rendering
