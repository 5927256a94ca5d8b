#include "drape/geometry/tangent_frames.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace drape {
namespace {

// Where u grows, by area in space, and which way round the picture lies on the surface, by area too.
struct FaceFrame {
  Eigen::Vector3d along_u = Eigen::Vector3d::Zero();
  double turn = 0;  // positive: as seen from outside
};

FaceFrame frame_of(const TexturedMesh& model, std::size_t f) {
  const Face& face = model.mesh.faces[f];
  const Eigen::Vector3d e1 = model.mesh.vertices[face[1]] - model.mesh.vertices[face[0]];
  const Eigen::Vector3d e2 = model.mesh.vertices[face[2]] - model.mesh.vertices[face[0]];
  const Eigen::Vector2d d1 = (model.corner_uvs[f][1] - model.corner_uvs[f][0]).cast<double>();
  const Eigen::Vector2d d2 = (model.corner_uvs[f][2] - model.corner_uvs[f][0]).cast<double>();
  const double area = d1.x() * d2.y() - d1.y() * d2.x();
  const Eigen::Vector3d along = (d2.y() * e1 - d1.y() * e2) * (area < 0 ? -1 : 1);
  const double twice = e1.cross(e2).norm();
  if (area == 0 || !(along.norm() > 0)) return {};
  // v points down: a picture that is not mirrored goes round the other way than its face.
  return {along.normalized() * twice, area < 0 ? twice : -twice};
}

// Corners in groups that share vertex, texture coordinates and material.
std::vector<std::uint32_t> sorted_corners(const TexturedMesh& model) {
  std::vector<std::uint32_t> corners(3 * model.mesh.faces.size());
  std::iota(corners.begin(), corners.end(), 0U);
  const auto key = [&](std::uint32_t corner) {
    const std::uint32_t f = corner / 3;
    const Eigen::Vector2f& uv = model.corner_uvs[f][corner % 3];
    return std::tuple(model.mesh.faces[f][corner % 3], model.face_materials[f], uv.x(), uv.y());
  };
  std::stable_sort(corners.begin(), corners.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return corners;
}

}  // namespace

std::vector<std::array<Eigen::Vector4f, 3>> corner_tangents(const TexturedMesh& model,
                                                            const std::vector<Eigen::Vector3f>& normals) {
  std::vector<FaceFrame> frames;
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) frames.push_back(frame_of(model, f));
  std::vector<std::array<Eigen::Vector4f, 3>> tangents(model.mesh.faces.size());
  const std::vector<std::uint32_t> corners = sorted_corners(model);
  const auto same = [&](std::uint32_t a, std::uint32_t b) {
    return model.mesh.faces[a / 3][a % 3] == model.mesh.faces[b / 3][b % 3] &&
           model.face_materials[a / 3] == model.face_materials[b / 3] &&
           model.corner_uvs[a / 3][a % 3] == model.corner_uvs[b / 3][b % 3];
  };
  for (std::size_t first = 0; first < corners.size();) {
    std::size_t end = first;
    FaceFrame sum;
    while (end < corners.size() && same(corners[first], corners[end])) {
      sum.along_u += frames[corners[end] / 3].along_u;
      sum.turn += frames[corners[end] / 3].turn;
      ++end;
    }
    const Eigen::Vector3d normal =
        normals[model.mesh.faces[corners[first] / 3][corners[first] % 3]].cast<double>();
    Eigen::Vector3d along = sum.along_u - normal * normal.dot(sum.along_u);
    if (!(along.norm() > 1e-6 * sum.along_u.norm()))
      along = normal.squaredNorm() > 0.5 ? normal.unitOrthogonal() : Eigen::Vector3d::UnitX();
    Eigen::Vector4f tangent;
    tangent << along.normalized().cast<float>(), sum.turn < 0 ? -1.F : 1.F;
    for (; first < end; ++first) tangents[corners[first] / 3][corners[first] % 3] = tangent;
  }
  return tangents;
}

}  // namespace drape
