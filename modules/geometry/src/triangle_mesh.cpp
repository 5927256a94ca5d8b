#include "drape/geometry/triangle_mesh.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace drape {
namespace {

template <class Attribute>
void take(std::vector<Attribute>& values, const std::vector<std::size_t>& chosen) {
  if (values.empty()) return;
  std::vector<Attribute> kept;
  kept.reserve(chosen.size());
  for (const std::size_t i : chosen) kept.push_back(values[i]);
  values = std::move(kept);
}

}  // namespace

Eigen::Vector3d scaled_face_normal(const TriangleMesh& mesh, std::size_t face) {
  const Face& f = mesh.faces[face];
  const Eigen::Vector3d& a = mesh.vertices[f[0]];
  return (mesh.vertices[f[1]] - a).cross(mesh.vertices[f[2]] - a);
}

std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> sums(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Eigen::Vector3d normal = scaled_face_normal(mesh, i);
    for (const std::uint32_t v : mesh.faces[i]) sums[v] += normal;
  }
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(sums.size());
  for (const Eigen::Vector3d& sum : sums) normals.push_back(sum.stableNormalized().cast<float>());
  return normals;
}

double surface_area(const TriangleMesh& mesh) {
  double twice = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) twice += scaled_face_normal(mesh, i).norm();
  return twice / 2;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  // About one of its vertices, so that a mesh far from the origin loses no digits.
  const Eigen::Vector3d origin = mesh.vertices.front();
  double six_times = 0;
  for (const Face& f : mesh.faces)
    six_times += (mesh.vertices[f[0]] - origin)
                     .dot((mesh.vertices[f[1]] - origin).cross(mesh.vertices[f[2]] - origin));
  return six_times / 6;
}

double median_edge_length(const TriangleMesh& mesh) {
  if (mesh.faces.empty()) return 0;
  std::vector<double> lengths;
  lengths.reserve(3 * mesh.faces.size());
  for (const Face& f : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k)
      lengths.push_back((mesh.vertices[f[(k + 1) % 3]] - mesh.vertices[f[k]]).norm());
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

TriangleMesh without_unused_vertices(const TriangleMesh& mesh) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> renamed(mesh.vertices.size(), unused);
  for (const Face& f : mesh.faces)
    for (const std::uint32_t v : f) renamed[v] = 0;
  std::vector<std::size_t> chosen;
  for (std::size_t v = 0; v < renamed.size(); ++v)
    if (renamed[v] != unused) {
      renamed[v] = static_cast<std::uint32_t>(chosen.size());
      chosen.push_back(v);
    }
  TriangleMesh kept = mesh;
  take(kept.vertices, chosen);
  take(kept.normals, chosen);
  take(kept.colors, chosen);
  take(kept.intensities, chosen);
  take(kept.confidences, chosen);
  for (Face& f : kept.faces)
    for (std::uint32_t& v : f) v = renamed[v];
  if (chosen.empty()) kept.vertices.clear();
  return kept;
}

TriangleMesh with_faces(const TriangleMesh& mesh, const std::vector<std::uint8_t>& keep) {
  TriangleMesh kept = mesh;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    if (keep[i]) chosen.push_back(i);
  take(kept.faces, chosen);
  take(kept.filled, chosen);
  if (chosen.empty()) kept.faces.clear();
  return without_unused_vertices(kept);
}

std::string problem_of(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    for (const std::uint32_t v : mesh.faces[i])
      if (v >= mesh.vertices.size())
        return fmt::format("face {} names vertex {}, but there are only {}", i, v, mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!mesh.vertices[i].allFinite())
      return fmt::format("vertex {} has a coordinate that is not a finite number", i);
  const auto wrong = [](std::size_t length, std::size_t expected) {
    return length != 0 && length != expected;
  };
  if (wrong(mesh.normals.size(), mesh.vertices.size())) return "the normals are not one per vertex";
  if (wrong(mesh.colors.size(), mesh.vertices.size())) return "the colours are not one per vertex";
  if (wrong(mesh.intensities.size(), mesh.vertices.size())) return "the intensities are not one per vertex";
  if (wrong(mesh.confidences.size(), mesh.vertices.size())) return "the confidences are not one per vertex";
  if (wrong(mesh.filled.size(), mesh.faces.size())) return "the filled marks are not one per face";
  return {};
}

}  // namespace drape
