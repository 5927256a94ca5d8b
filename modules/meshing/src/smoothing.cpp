#include "smoothing.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "drape/base/parallel.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "vertex_faces.hpp"

namespace drape::meshing {
namespace {

// Normals that differ by more than about this (a chord on the unit sphere: 20 degrees) are an edge's two
// sides.
constexpr double crease = 0.35;
constexpr std::size_t items_per_chunk = 4096;

struct FaceShape {
  Eigen::Vector3d centroid;
  Eigen::Vector3d normal;  // zero for a face without area
  double area;
};

template <class Value, class Compute>
std::vector<Value> computed(std::size_t count, Compute compute) {
  std::vector<Value> values(count);
  parallel_for(count, items_per_chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) values[i] = compute(i);
  });
  return values;
}

FaceShape shape_of(const TriangleMesh& mesh, std::size_t face) {
  const Face& f = mesh.faces[face];
  const Eigen::Vector3d scaled = scaled_face_normal(mesh, face);
  const double length = scaled.norm();
  const Eigen::Vector3d normal = length > 0 ? Eigen::Vector3d(scaled / length) : Eigen::Vector3d::Zero();
  return {(mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3, normal, length / 2};
}

double mean_centroid_distance(const TriangleMesh& mesh) {
  return median_edge_length(mesh) / std::sqrt(3.0);  // exact for equilateral faces
}

// The mean of the normals round a face, by area, nearness and likeness (Zheng et al., equation 3).
Eigen::Vector3d filtered_normal(const TriangleMesh& mesh, const VertexFaces& around,
                                const std::vector<FaceShape>& shapes, std::size_t face, double reach) {
  const FaceShape& here = shapes[face];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t v : mesh.faces[face])
    for (const std::uint32_t other : around.of(v)) {
      const FaceShape& there = shapes[other];
      const double distance = (there.centroid - here.centroid).squaredNorm() / (reach * reach);
      const double turn = (there.normal - here.normal).squaredNorm() / (crease * crease);
      sum += there.area * std::exp(-(distance + turn) / 2) * there.normal;
    }
  const double length = sum.norm();
  return length > 0 ? Eigen::Vector3d(sum / length) : here.normal;
}

// Moves the vertex so that the faces round it turn towards their filtered normals (Sun et al., equation 7).
Eigen::Vector3d moved_vertex(const TriangleMesh& mesh, const VertexFaces& around,
                             const std::vector<Eigen::Vector3d>& normals, std::size_t v) {
  const auto faces = around.of(static_cast<std::uint32_t>(v));
  Eigen::Vector3d move = Eigen::Vector3d::Zero();
  for (const std::uint32_t face : faces) {
    const Face& f = mesh.faces[face];
    const Eigen::Vector3d centroid = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
    move += normals[face] * normals[face].dot(centroid - mesh.vertices[v]);
  }
  return mesh.vertices[v] + move / static_cast<double>(faces.size());
}

std::vector<std::uint8_t> fixed_vertices(const TriangleMesh& mesh, const VertexFaces& around) {
  std::vector<std::uint8_t> fixed(mesh.vertices.size(), 0);
  for (std::uint32_t v = 0; v < fixed.size(); ++v) fixed[v] = around.of(v).empty() ? 1 : 0;
  for (const BoundaryLoop& loop : boundary_loops(mesh))
    for (const std::uint32_t v : loop.vertices) fixed[v] = 1;
  return fixed;
}

}  // namespace

TriangleMesh smoothed(const TriangleMesh& mesh, int rounds) {
  if (rounds == 0 || mesh.empty()) return mesh;
  const VertexFaces around(mesh);
  const std::vector<std::uint8_t> fixed = fixed_vertices(mesh, around);
  const double reach = mean_centroid_distance(mesh);
  TriangleMesh result = mesh;
  for (int round = 0; round < rounds; ++round) {
    const auto shapes =
        computed<FaceShape>(mesh.faces.size(), [&](std::size_t i) { return shape_of(result, i); });
    const auto normals = computed<Eigen::Vector3d>(
        mesh.faces.size(), [&](std::size_t i) { return filtered_normal(result, around, shapes, i, reach); });
    constexpr int vertex_steps = 5;  // towards one set of normals
    for (int step = 0; step < vertex_steps; ++step)
      result.vertices = computed<Eigen::Vector3d>(mesh.vertices.size(), [&](std::size_t v) {
        return fixed[v] != 0 ? result.vertices[v] : moved_vertex(result, around, normals, v);
      });
  }
  if (!result.normals.empty()) result.normals = vertex_normals(result);
  return result;
}

}  // namespace drape::meshing
