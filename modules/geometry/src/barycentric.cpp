#include "drape/geometry/barycentric.hpp"

#include <Eigen/Geometry>

namespace drape {

Eigen::Vector3d barycentric_weights(const TriangleMesh& mesh, std::size_t face,
                                    const Eigen::Vector3d& point) {
  const Face& f = mesh.faces[face];
  const Eigen::Vector3d scaled = scaled_face_normal(mesh, face);
  const double square = scaled.squaredNorm();
  if (!(square > 0)) return Eigen::Vector3d::Constant(1.0 / 3);
  Eigen::Vector3d weights;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& b = mesh.vertices[f[(k + 1) % 3]];
    const Eigen::Vector3d& c = mesh.vertices[f[(k + 2) % 3]];
    weights[static_cast<Eigen::Index>(k)] = (b - point).cross(c - point).dot(scaled) / square;
  }
  return weights;
}

}  // namespace drape
