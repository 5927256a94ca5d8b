#include "drape/geometry/triangle_mesh.hpp"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "drape/base/parallel.hpp"
#include "drape/geometry/mesh_packing.hpp"

namespace drape {
namespace {

// Values of which renamed[i] is not `unused` move there, which is never behind their own place.
constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

template <class Attribute>
void take(std::vector<Attribute>& values, const std::vector<std::uint32_t>& renamed) {
  if (values.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < renamed.size(); ++i)
    if (renamed[i] != unused) values[kept++] = values[i];
  values.resize(kept);
}

template <class Attribute>
void take_faces(std::vector<Attribute>& values, const std::vector<std::uint8_t>& keep) {
  if (values.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) values[kept++] = values[i];
  values.resize(kept);
}

// The least and the greatest vertex of consecutive faces, which in most meshes lie near each other.
struct FaceRun {
  static constexpr std::size_t faces = 65536;
  std::uint32_t first_vertex = unused;
  std::uint32_t last_vertex = 0;
};

std::vector<FaceRun> face_runs(const TriangleMesh& mesh) {
  std::vector<FaceRun> runs((mesh.faces.size() + FaceRun::faces - 1) / FaceRun::faces);
  parallel_for(mesh.faces.size(), FaceRun::faces, [&](std::size_t begin, std::size_t end) {
    FaceRun& run = runs[begin / FaceRun::faces];
    for (std::size_t i = begin; i < end; ++i)
      for (const std::uint32_t v : mesh.faces[i]) {
        run.first_vertex = std::min(run.first_vertex, v);
        run.last_vertex = std::max(run.last_vertex, v);
      }
  });
  return runs;
}

}  // namespace

Eigen::Vector3d scaled_face_normal(const TriangleMesh& mesh, std::size_t face) {
  const Face& f = mesh.faces[face];
  const Eigen::Vector3d& a = mesh.vertices[f[0]];
  return (mesh.vertices[f[1]] - a).cross(mesh.vertices[f[2]] - a);
}

std::vector<Eigen::Vector3f> vertex_normals(const TriangleMesh& mesh) {
  const std::vector<FaceRun> runs = face_runs(mesh);
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size());
  // A range of vertices at a time: the sums of all would take as much memory as the vertices.
  constexpr std::size_t vertices_at_a_time = 1U << 20;
  parallel_for(normals.size(), vertices_at_a_time, [&](std::size_t first, std::size_t end) {
    std::vector<Eigen::Vector3d> sums(end - first, Eigen::Vector3d::Zero());
    for (std::size_t r = 0; r < runs.size(); ++r) {
      if (runs[r].last_vertex < first || runs[r].first_vertex >= end) continue;
      const std::size_t end_face = std::min(mesh.faces.size(), (r + 1) * FaceRun::faces);
      for (std::size_t i = r * FaceRun::faces; i < end_face; ++i) {
        const Face& f = mesh.faces[i];
        if (std::none_of(f.begin(), f.end(), [&](std::uint32_t v) { return v >= first && v < end; }))
          continue;
        const Eigen::Vector3d normal = scaled_face_normal(mesh, i);
        for (const std::uint32_t v : f)
          if (v >= first && v < end) sums[v - first] += normal;
      }
    }
    for (std::size_t v = first; v < end; ++v) normals[v] = sums[v - first].stableNormalized().cast<float>();
  });
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

void drop_unused_vertices(TriangleMesh& mesh) {
  std::vector<std::uint32_t> renamed(mesh.vertices.size(), unused);
  for (const Face& f : mesh.faces)
    for (const std::uint32_t v : f) renamed[v] = 0;
  std::uint32_t kept = 0;
  for (std::uint32_t& name : renamed)
    if (name != unused) name = kept++;
  if (kept == renamed.size()) return;
  take(mesh.vertices, renamed);
  take(mesh.normals, renamed);
  take(mesh.colors, renamed);
  take(mesh.intensities, renamed);
  take(mesh.confidences, renamed);
  for (Face& f : mesh.faces)
    for (std::uint32_t& v : f) v = renamed[v];
}

TriangleMesh without_unused_vertices(const TriangleMesh& mesh) {
  TriangleMesh kept = mesh;
  drop_unused_vertices(kept);
  return kept;
}

TriangleMesh with_faces(const TriangleMesh& mesh, const std::vector<std::uint8_t>& keep) {
  TriangleMesh kept = mesh;
  take_faces(kept.faces, keep);
  take_faces(kept.filled, keep);
  drop_unused_vertices(kept);
  return kept;
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
