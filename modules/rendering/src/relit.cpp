#include "drape/rendering/relit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "crease_normals.hpp"
#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/barycentric.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/tangent_frames.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/rendering/shadow_map.hpp"

namespace drape::rendering {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int soft_maps = 12;

float linear(float stored) {
  return stored <= 0.04045F ? stored / 12.92F : std::pow((stored + 0.055F) / 1.055F, 2.4F);
}
std::uint8_t byte_of(float light) {
  const float v = std::clamp(light, 0.F, 1.F);
  const float stored = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255 * stored));
}

// The model's normals at any point of its faces.
class ModelNormals {
 public:
  explicit ModelNormals(const TexturedMesh& model) : model_(model), split_(split_at_creases(model.mesh)) {
    if (std::none_of(model.materials.begin(), model.materials.end(),
                     [](const Material& m) { return !m.normal_map.empty(); }))
      return;
    smooth_ = model.mesh.normals.empty() ? vertex_normals(model.mesh) : model.mesh.normals;
    tangents_ = corner_tangents(model, smooth_);
  }

  /// Unit length, as the surface is wound.
  [[nodiscard]] Vector3d at(std::size_t face, const Vector3d& weights) const {
    const Image8& map = model_.materials[model_.face_materials[face]].normal_map;
    Vector3f normal = Vector3f::Zero();
    Eigen::Vector4f tangent = Eigen::Vector4f::Zero();
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto w = static_cast<float>(weights[static_cast<Eigen::Index>(k)]);
      if (map.empty()) {
        normal += w * split_.normals[split_.faces[face][k]];
        continue;
      }
      normal += w * smooth_[model_.mesh.faces[face][k]];
      tangent += w * tangents_[face][k];
      uv += w * model_.corner_uvs[face][k];
    }
    if (map.empty()) return normal.cast<double>().stableNormalized();
    const Vector3f n = normal.normalized();
    const Vector3f t = tangent.head<3>();
    const Vector3f b = n.cross(t) * (tangent.w() < 0 ? -1.F : 1.F);
    const Vector3f bent = looked_up(map, uv);
    return (bent.x() * t + bent.y() * b + bent.z() * n).cast<double>().stableNormalized();
  }

 private:
  // Bilinear, clamped at the border, -1..1.
  static Vector3f looked_up(const Image8& map, const Eigen::Vector2f& uv) {
    const float px =
        std::clamp(uv.x() * static_cast<float>(map.width()) - 0.5F, 0.F, static_cast<float>(map.width() - 1));
    const float py = std::clamp(uv.y() * static_cast<float>(map.height()) - 0.5F, 0.F,
                                static_cast<float>(map.height() - 1));
    const int x = static_cast<int>(px);
    const int y = static_cast<int>(py);
    const int right = std::min(x + 1, map.width() - 1);
    const int below = std::min(y + 1, map.height() - 1);
    const float fx = px - static_cast<float>(x);
    const float fy = py - static_cast<float>(y);
    Vector3f sum;
    for (int c = 0; c < 3; ++c)
      sum[c] = (1 - fy) * ((1 - fx) * static_cast<float>(map.at(x, y, c)) +
                           fx * static_cast<float>(map.at(right, y, c))) +
               fy * ((1 - fx) * static_cast<float>(map.at(x, below, c)) +
                     fx * static_cast<float>(map.at(right, below, c)));
    return (sum / 127.5F).array() - 1.F;
  }

  const TexturedMesh& model_;
  SplitVertices split_;
  std::vector<Vector3f> smooth_;
  std::vector<std::array<Eigen::Vector4f, 3>> tangents_;
};

}  // namespace

Image8 render_relit(const TexturedMesh& model, const Camera& camera, const RelitStyle& style) {
  const Vector3d towards = style.towards_light.stableNormalized();
  if (!(std::abs(towards.norm() - 1) < 1e-6))
    throw input_error("the light comes from nowhere: its direction is zero");
  const int n = style.samples_per_side;
  const Camera fine = camera.resized(camera.width * n, camera.height * n);
  TexturedStyle unlit;
  unlit.samples_per_side = 1;
  const Image8 paint = render_textured(model, fine, unlit);  // checks the model and the size as well
  Renderer renderer(model.mesh);
  const DepthMap seen = renderer.depth_map(fine);
  const ModelNormals normals(model);
  const SoftShadow shadow(renderer, bounding_box(model.mesh.vertices), towards,
                          style.softness_deg * std::numbers::pi / 180, style.softness_deg > 0 ? soft_maps : 1,
                          style.shadow_map_px);
  const auto light_at = [&](int x, int y) {
    const auto face = static_cast<std::size_t>(seen.faces.at(x, y));
    const Vector3d point = fine.unproject({x + 0.5, y + 0.5}, seen.depth.at(x, y));
    Vector3d flat = scaled_face_normal(model.mesh, face).stableNormalized();
    Vector3d normal =
        normals.at(face, barycentric_weights(model.mesh, face, point).cwiseMax(0.0).cwiseMin(1.0));
    if (flat.dot(fine.towards_camera(point)) < 0) {
      flat = -flat;
      normal = -normal;
    }
    const double cosine = normal.dot(towards);
    const double lamp = cosine > 0 && flat.dot(towards) > 0 ? cosine * shadow.lit(point, flat) : 0;
    return static_cast<float>(style.ambient + style.intensity * lamp);
  };
  Image8 picture(camera.width, camera.height, 3);
  parallel_for(static_cast<std::size_t>(camera.height), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < camera.width; ++x) {
        Vector3f sum = Vector3f::Zero();
        for (int s = 0; s < n * n; ++s) {
          const int column = x * n + s % n;
          const int row = y * n + s / n;
          const bool nothing = seen.faces.at(column, row) == DepthMap::no_face;
          const float light = nothing ? 1.F : light_at(column, row);
          for (int c = 0; c < 3; ++c)
            sum[c] += light * linear(nothing ? style.background[c]
                                             : static_cast<float>(paint.at(column, row, c)) / 255.F);
        }
        for (int c = 0; c < 3; ++c) picture.at(x, y, c) = byte_of(sum[c] / static_cast<float>(n * n));
      }
  });
  return picture;
}

}  // namespace drape::rendering
