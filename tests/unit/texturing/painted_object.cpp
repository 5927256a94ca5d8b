#include "painted_object.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "drape/rendering/renderer.hpp"
#include "face_edges.hpp"

namespace drape::texturing {
namespace {

// Calls visit(point, texture coordinate) at points inside a face.
template <class Visit>
void for_points_of(const TexturedMesh& model, std::size_t face, Visit visit) {
  constexpr int n = 4;
  const Face& f = model.mesh.faces[face];
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      const double u = (i + 1 / 3.0) / n;
      const double v = (j + 1 / 3.0) / n;
      const Eigen::Vector3d x = (1 - u - v) * model.mesh.vertices[f[0]] + u * model.mesh.vertices[f[1]] +
                                v * model.mesh.vertices[f[2]];
      const auto& corner = model.corner_uvs[face];
      const Eigen::Vector2d uv = (1 - u - v) * corner[0].cast<double>() + u * corner[1].cast<double>() +
                                 v * corner[2].cast<double>();
      visit(x, uv);
    }
}

template <class Visit>
void for_painted_points(const TexturedMesh& model, Visit visit) {
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
    if (!is_painted(model, f)) continue;
    const Image8& image = model.materials[model.face_materials[f]].image;
    for_points_of(model, f,
                  [&](const Eigen::Vector3d& x, const Eigen::Vector2d& uv) { visit(x, sampled(image, uv)); });
  }
}

}  // namespace

Paint waves(double wavelength) {
  return [k = 2 * std::numbers::pi / wavelength](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(30 + 20 * std::sin(k * (x.x() + x.y() + x.z())),
                           128 + 90 * std::sin(k * (x.x() + 0.5 * x.z())),
                           128 + 90 * std::cos(k * (x.y() - 0.7 * x.z())));
  };
}

Shot photographed(const TriangleMesh& mesh, const Camera& camera, const Paint& paint) {
  Shot shot{Image8(camera.width, camera.height, 3),
            Image8(camera.width, camera.height, 1, stencil::background), camera};
  rendering::Renderer renderer(mesh);
  const rendering::DepthMap map = renderer.depth_map(camera);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      Eigen::Vector3d color = background_color;
      if (map.faces.at(x, y) != rendering::DepthMap::no_face) {
        shot.stencil.at(x, y) = stencil::object;
        color = paint(camera.unproject({x + 0.5, y + 0.5}, map.depth.at(x, y)));
      }
      for (int c = 0; c < 3; ++c) shot.photo.at(x, y, c) = static_cast<std::uint8_t>(std::lround(color[c]));
    }
  return shot;
}

Eigen::Vector3d sampled(const Image8& image, const Eigen::Vector2d& uv) {
  const double fx = std::clamp(uv.x() * image.width() - 0.5, 0.0, image.width() - 1.0);
  const double fy = std::clamp(uv.y() * image.height() - 0.5, 0.0, image.height() - 1.0);
  const int x = static_cast<int>(fx);
  const int y = static_cast<int>(fy);
  const int right = std::min(x + 1, image.width() - 1);
  const int below = std::min(y + 1, image.height() - 1);
  Eigen::Vector3d color;
  for (int c = 0; c < 3; ++c)
    color[c] = (1 - (fy - y)) * ((1 - (fx - x)) * image.at(x, y, c) + (fx - x) * image.at(right, y, c)) +
               (fy - y) * ((1 - (fx - x)) * image.at(x, below, c) + (fx - x) * image.at(right, below, c));
  return color;
}

bool is_painted(const TexturedMesh& model, std::size_t face) {
  return !model.materials[model.face_materials[face]].image.empty();
}

double largest_error(const TexturedMesh& model, const Paint& paint,
                     const std::function<bool(const Eigen::Vector3d&)>& counts) {
  double most = 0;
  for_painted_points(model, [&](const Eigen::Vector3d& x, const Eigen::Vector3d& color) {
    if (counts(x)) most = std::max(most, (color - paint(x)).cwiseAbs().maxCoeff());
  });
  return most;
}

double least_distance_to(const TexturedMesh& model, const Eigen::Vector3d& other) {
  double least = std::numeric_limits<double>::infinity();
  for_painted_points(model, [&](const Eigen::Vector3d&, const Eigen::Vector3d& color) {
    least = std::min(least, (color - other).norm());
  });
  return least;
}

double mean_step_across_seams(const TexturedMesh& model) {
  double sum = 0;
  double length = 0;
  const auto sides_of = [&](std::uint32_t f, std::uint32_t vertex) -> Eigen::Vector2d {
    const Face& face = model.mesh.faces[f];
    const auto k = std::find(face.begin(), face.end(), vertex) - face.begin();
    return model.corner_uvs[f][static_cast<std::size_t>(k)].cast<double>();
  };
  for (const FaceEdge& e : face_edges(model.mesh)) {
    if (!is_painted(model, e.first) || !is_painted(model, e.second)) continue;
    if (model.face_materials[e.first] == model.face_materials[e.second] &&
        sides_of(e.first, e.low) == sides_of(e.second, e.low))
      continue;
    const double weight = (model.mesh.vertices[e.low] - model.mesh.vertices[e.high]).norm();
    for (const double t : {0.25, 0.5, 0.75}) {
      std::array<Eigen::Vector3d, 2> colors;
      for (std::size_t i = 0; i < 2; ++i) {
        const std::uint32_t f = i == 0 ? e.first : e.second;
        colors[i] = sampled(model.materials[model.face_materials[f]].image,
                            (1 - t) * sides_of(f, e.low) + t * sides_of(f, e.high));
      }
      sum += weight * (colors[0] - colors[1]).cwiseAbs().maxCoeff();
      length += weight;
    }
  }
  return length > 0 ? sum / length : 0;
}

double painted_area(const TexturedMesh& model) {
  double twice = 0;
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f)
    if (is_painted(model, f)) twice += scaled_face_normal(model.mesh, f).norm();
  return twice / 2;
}

std::string problem_of_model(const TexturedMesh& model) {
  if (const std::string problem = problem_of(model.mesh); !problem.empty()) return problem;
  if (model.corner_uvs.size() != model.mesh.faces.size()) return "texture coordinates are missing";
  if (model.face_materials.size() != model.mesh.faces.size()) return "materials are missing";
  for (const std::uint32_t m : model.face_materials)
    if (m >= model.materials.size()) return "a material that does not exist";
  for (const auto& corners : model.corner_uvs)
    for (const Eigen::Vector2f& uv : corners)
      if (!(uv.minCoeff() >= 0 && uv.maxCoeff() <= 1)) return "a texture coordinate outside of 0..1";
  return {};
}

}  // namespace drape::texturing
