#include "surface_view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace drape::alignment {
namespace {

constexpr float crease_cosine = 0.766F;

Eigen::Vector3f area_normal(const OutlineMesh& mesh, const Face& f) {
  const Eigen::Vector3d& a = mesh.vertices[f[0]];
  return (mesh.vertices[f[1]] - a).cross(mesh.vertices[f[2]] - a).cast<float>();
}

bool one_sided(const OutlineMesh& mesh) {
  return mesh.open && std::none_of(mesh.edges.begin(), mesh.edges.end(),
                                   [](const OutlineEdge& edge) { return edge.turned; });
}

}  // namespace

LitMesh lit_mesh(const OutlineMesh& mesh, const std::vector<Eigen::Vector3f>& colors) {
  LitMesh lit;
  lit.mesh = &mesh;
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(mesh.faces.size());
  std::vector<std::uint32_t> begin(mesh.vertices.size() + 1, 0);
  for (const Face& f : mesh.faces) {
    normals.push_back(area_normal(mesh, f));
    for (const std::uint32_t v : f) ++begin[v + 1];
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<std::uint32_t> around(begin.back());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f)
    for (const std::uint32_t v : mesh.faces[f]) around[next[v]++] = f;
  lit.corner_normals.resize(3 * mesh.faces.size(), Eigen::Vector3f::Zero());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Eigen::Vector3f own = normals[f].normalized();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.faces[f][k];
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::uint32_t i = begin[v]; i < begin[v + 1]; ++i) {
        const Eigen::Vector3f& other = normals[around[i]];
        if (other.dot(own) >= crease_cosine * other.norm()) sum += other;
      }
      lit.corner_normals[3 * f + k] = sum.norm() > 0 ? Eigen::Vector3f(sum.normalized()) : own;
    }
  }
  lit.one_sided = one_sided(mesh);
  if (colors.size() == mesh.vertices.size())
    for (const Eigen::Vector3f& color : colors) lit.brightness.push_back(color.mean());
  return lit;
}

void SurfaceDrawing::draw(const LitMesh& lit, const OutlinePose& pose, const Window& window) {
  const OutlineMesh& mesh = *lit.mesh;
  places_.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3d turned = pose.rotation * mesh.vertices[v];
    const Eigen::Vector2d place = window.from_photo(pose.place(turned));
    places_[v] = Eigen::Vector3d(place.x(), place.y(), turned.z()).cast<float>();
  }
  pixels_.assign(static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height), {});
  const Eigen::Matrix3f rotation = pose.rotation.cast<float>();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    draw_face(lit, f, rotation, window.width, window.height);
}

void SurfaceDrawing::draw_face(const LitMesh& lit, std::size_t face, const Eigen::Matrix3f& rotation,
                               int width, int height) {
  const Face& corners = lit.mesh->faces[face];
  const Eigen::Vector3f& a = places_[corners[0]];
  const Eigen::Vector3f& b = places_[corners[1]];
  const Eigen::Vector3f& c = places_[corners[2]];
  const float twice_area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  if (twice_area == 0 || (lit.mesh->closed && twice_area > 0)) return;
  const auto first = [](float x, int most) {
    return static_cast<int>(std::clamp(std::ceil(x - 0.5F), 0.0F, static_cast<float>(most)));
  };
  const int left = first(std::min({a.x(), b.x(), c.x()}), width);
  const int right = first(std::max({a.x(), b.x(), c.x()}), width);
  const int top = first(std::min({a.y(), b.y(), c.y()}), height);
  const int bottom = first(std::max({a.y(), b.y(), c.y()}), height);
  if (left >= right || top >= bottom) return;
  const float side = twice_area < 0 ? 1.0F : -1.0F;  // whichever side of a face is seen looks at the camera
  const Eigen::Vector3f* normals = &lit.corner_normals[3 * face];
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const float px = static_cast<float>(x) + 0.5F;
      const float py = static_cast<float>(y) + 0.5F;
      const float wb = ((px - a.x()) * (c.y() - a.y()) - (py - a.y()) * (c.x() - a.x())) / twice_area;
      const float wc = ((b.x() - a.x()) * (py - a.y()) - (b.y() - a.y()) * (px - a.x())) / twice_area;
      const float wa = 1 - wb - wc;
      if (wa < 0 || wb < 0 || wc < 0) continue;
      SurfacePixel& pixel = pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                    static_cast<std::size_t>(x)];
      const float depth = wa * a.z() + wb * b.z() + wc * c.z();
      if (pixel.covered && depth >= pixel.depth) continue;
      pixel.covered = true;
      pixel.depth = depth;
      pixel.seen = side > 0 || !lit.one_sided;
      if (!pixel.seen) continue;
      pixel.normal = side * (rotation * (wa * normals[0] + wb * normals[1] + wc * normals[2]).normalized());
      if (!lit.brightness.empty())
        pixel.brightness = wa * lit.brightness[corners[0]] + wb * lit.brightness[corners[1]] +
                           wc * lit.brightness[corners[2]];
    }
}

double inner_side_share(const OutlineMesh& mesh, const OutlinePose& pose, const Window& window) {
  if (!one_sided(mesh)) return 0;
  SurfaceDrawing drawing;
  drawing.draw(lit_mesh(mesh, {}), pose, window);
  double covered = 0;
  double inner = 0;
  for (const SurfacePixel& pixel : drawing.pixels()) {
    covered += pixel.covered ? 1 : 0;
    inner += pixel.covered && !pixel.seen ? 1 : 0;
  }
  return covered > 0 ? inner / covered : 0;
}

}  // namespace drape::alignment
