#include "face_depth.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "drape/base/parallel.hpp"

namespace drape::rendering {
namespace {

// Depth along the ray through K^-1 (u, v, 1) of one face, kept from pixel to pixel.
class FacePlane {
 public:
  FacePlane(const std::array<Eigen::Vector3d, 3>& corners, bool perspective)
      : perspective_(perspective), corner_(corners[0]) {
    normal_ = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    least_ = std::min({corners[0].z(), corners[1].z(), corners[2].z()});
    most_ = std::max({corners[0].z(), corners[1].z(), corners[2].z()});
  }

  [[nodiscard]] double depth(const Eigen::Vector3d& ray) const {
    // Perspective: normal . (depth ray) = normal . corner. Orthographic: normal . (ray.x, ray.y, depth) the
    // same.
    const double depth =
        perspective_ ? normal_.dot(corner_) / normal_.dot(ray)
                     : corner_.z() - normal_.head<2>().dot(ray.head<2>() - corner_.head<2>()) / normal_.z();
    if (!std::isfinite(depth)) return least_;
    return std::clamp(depth, least_, most_);
  }

 private:
  bool perspective_;
  Eigen::Vector3d corner_;
  Eigen::Vector3d normal_;
  double least_;
  double most_;
};

}  // namespace

ImageF depth_of_faces(const TriangleMesh& mesh, const Camera& camera, const Image<std::int32_t>& faces) {
  ImageF depths(faces.width(), faces.height(), 1, std::numeric_limits<float>::infinity());
  const Eigen::Matrix3d ray_from_pixel = camera.K.inverse();
  const bool perspective = camera.projection == Camera::Projection::perspective;
  const auto plane_of = [&](std::int32_t face) {
    std::array<Eigen::Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = camera.camera_from_world * mesh.vertices[mesh.faces[static_cast<std::size_t>(face)][k]];
    return FacePlane(corners, perspective);
  };
  parallel_for(static_cast<std::size_t>(faces.height()), 64, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      std::int32_t known = -1;
      FacePlane plane({Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()},
                      perspective);
      for (int x = 0; x < faces.width(); ++x) {
        const std::int32_t face = faces.at(x, y);
        if (face < 0) continue;
        if (face != known) plane = plane_of(known = face);
        depths.at(x, y) =
            static_cast<float>(plane.depth(ray_from_pixel * Eigen::Vector3d(x + 0.5, y + 0.5, 1)));
      }
    }
  });
  return depths;
}

}  // namespace drape::rendering
