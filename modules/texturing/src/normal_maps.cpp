#include "drape/texturing/normal_maps.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/tangent_frames.hpp"
#include "drape/metrics/surface_tree.hpp"
#include "pull_push.hpp"
#include "surface_normals.hpp"
#include "triangle_raster.hpp"

namespace drape::texturing {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double same_way = 0.3;  // cosine between the model's normal and the full mesh's
constexpr double fringe_px = 1.5;

class Baker {
 public:
  Baker(const TexturedMesh& model, const TriangleMesh& full)
      : model_(model),
        smooth_(model.mesh.normals.empty() ? vertex_normals(model.mesh) : model.mesh.normals),
        tangents_(corner_tangents(model, smooth_)),
        full_normals_(full),
        tree_(full) {}

  [[nodiscard]] Image8 baked(std::uint32_t material, int width, int height) const {
    WeightedPixels pixels(width, height);
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < model_.face_materials.size(); ++f)
      if (model_.face_materials[f] == material) faces.push_back(f);
    // Bands of rows, so that the order of faces decides about shared texels whatever the threads do.
    constexpr int rows = 16;
    parallel_for(static_cast<std::size_t>((height + rows - 1) / rows), 1,
                 [&](std::size_t begin, std::size_t end) {
                   for (std::size_t band = begin; band < end; ++band) {
                     const int top = static_cast<int>(band) * rows;
                     for (const double margin : {0.0, fringe_px})
                       paint(faces, margin, {0, top, width, std::min(height, top + rows)}, pixels);
                   }
                 });
    pixels = pull_pushed(std::move(pixels));
    Image8 map(width, height, 3);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        Vector3f n = 2 * pixels.at(x, y).head<3>().array() - 1.F;
        n = n.norm() > 0.1F && pixels.at(x, y).w() > 0 ? Vector3f(n.normalized()) : Vector3f::UnitZ();
        for (int c = 0; c < 3; ++c)
          map.at(x, y, c) = static_cast<std::uint8_t>(std::lround(127.5F * (n[c] + 1)));
      }
    return map;
  }

 private:
  void paint(const std::vector<std::uint32_t>& faces, double margin, const TexelBounds& bounds,
             WeightedPixels& pixels) const {
    const Eigen::Vector2d size(pixels.width, pixels.height);
    for (const std::uint32_t f : faces) {
      std::array<Eigen::Vector2d, 3> texels;
      for (std::size_t k = 0; k < 3; ++k)
        texels[k] = model_.corner_uvs[f][k].cast<double>().cwiseProduct(size);
      const auto [least, most] = std::minmax({texels[0].y(), texels[1].y(), texels[2].y()});
      if (most + margin < bounds.top || least - margin > bounds.bottom) continue;
      for_texels(texels, margin, bounds, [&](int x, int y, const Vector3d& weights) {
        if (pixels.at(x, y).w() > 0) return;
        pixels.at(x, y) << (normal_at(f, weights).array() + 1.F) / 2.F, 1.F;
      });
    }
  }

  // In the tangent frame.
  [[nodiscard]] Vector3f normal_at(std::uint32_t f, const Vector3d& weights) const {
    const Face& face = model_.mesh.faces[f];
    Vector3d point = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
    Eigen::Vector4d tangent = Eigen::Vector4d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = weights[static_cast<Eigen::Index>(k)];
      point += w * model_.mesh.vertices[face[k]];
      normal += w * smooth_[face[k]].cast<double>();
      tangent += w * tangents_[f][k].cast<double>();
    }
    normal.stableNormalize();
    const metrics::SurfaceTree::Closest closest = tree_.closest(point);
    const Vector3d wanted = full_normals_.at(closest.face, closest.point);
    if (!(wanted.dot(normal) > same_way)) return Vector3f::UnitZ();
    // As a viewer does, the tangent is not made perpendicular again: only solving for the three numbers gives
    // back the normal.
    Eigen::Matrix3d axes;
    axes.col(0) = tangent.head<3>();
    axes.col(1) = normal.cross(tangent.head<3>()) * (tangent.w() < 0 ? -1 : 1);
    axes.col(2) = normal;
    if (!(std::abs(axes.determinant()) > 1e-3)) return Vector3f::UnitZ();
    const Vector3d bent = axes.inverse() * wanted;
    return bent.z() > 0 ? Vector3f(bent.stableNormalized().cast<float>()) : Vector3f::UnitZ();
  }

  const TexturedMesh& model_;
  std::vector<Vector3f> smooth_;
  std::vector<std::array<Eigen::Vector4f, 3>> tangents_;
  SurfaceNormals full_normals_;
  metrics::SurfaceTree tree_;
};

}  // namespace

TexturedMesh with_normal_maps(TexturedMesh model, const TriangleMesh& full, int most_side_px,
                              const Progress& progress) {
  if (const std::string problem = problem_of(model.mesh); !problem.empty())
    throw input_error("the model cannot get normal maps: {}", problem);
  const Baker baker(model, full);
  for (std::uint32_t m = 0; m < model.materials.size(); ++m) {
    progress.update(static_cast<double>(m) / static_cast<double>(model.materials.size()), "normal maps");
    const Image8& image = model.materials[m].image;
    if (image.empty()) continue;
    const double factor =
        std::min(1.0, static_cast<double>(most_side_px) / std::max(image.width(), image.height()));
    model.materials[m].normal_map =
        baker.baked(m, std::max(1, static_cast<int>(std::lround(factor * image.width()))),
                    std::max(1, static_cast<int>(std::lround(factor * image.height()))));
  }
  return model;
}

}  // namespace drape::texturing
