#include "surface_normals.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace drape::texturing {
namespace {

// A vertex whose mean normal is farther than this from its face's lies on a crease of that face.
const double crease_cosine = std::cos(0.5);  // 29 degrees

}  // namespace

SurfaceNormals::SurfaceNormals(const TriangleMesh& mesh) : mesh_(mesh) {
  const std::vector<Eigen::Vector3f> at_vertices = vertex_normals(mesh);
  face_normals_.reserve(mesh.faces.size());
  corner_normals_.reserve(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Eigen::Vector3d normal = scaled_face_normal(mesh, f).stableNormalized();
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d smooth = at_vertices[mesh.faces[f][k]].cast<double>();
      corners[k] = smooth.dot(normal) >= crease_cosine ? smooth : normal;
    }
    face_normals_.push_back(normal);
    corner_normals_.push_back(corners);
  }
}

Eigen::Vector3d SurfaceNormals::at(std::uint32_t face, const Eigen::Vector3d& point) const {
  return unscaled_at(face, point).stableNormalized();
}

Eigen::Vector3d SurfaceNormals::unscaled_at(std::uint32_t face, const Eigen::Vector3d& point) const {
  const Face& f = mesh_.faces[face];
  const Eigen::Vector3d scaled = scaled_face_normal(mesh_, face);
  const double twice_area = scaled.norm();
  if (twice_area == 0) return Eigen::Vector3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector3d& b = mesh_.vertices[f[(k + 1) % 3]];
    const Eigen::Vector3d& c = mesh_.vertices[f[(k + 2) % 3]];
    const double weight = (b - point).cross(c - point).dot(scaled) / (twice_area * twice_area);
    sum += weight * corner_normals_[face][k];
  }
  return sum;
}

}  // namespace drape::texturing
