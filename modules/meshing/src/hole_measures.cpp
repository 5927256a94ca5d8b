#include "hole_measures.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace drape::meshing {
namespace {

// A border shorter than this is too short to tell a cut from a tear.
constexpr double least_base_length_spacings = 30;
constexpr double steep = 0.7;  // sine of 45 degrees

// Mean sine of the angle between the loop's plane and the faces on the loop, by edge length. By the faces'
// normals, not by the way across each edge: a border that runs in steps is as steep as a straight one.
double mean_steepness(const TriangleMesh& mesh, const VertexFaces& around,
                      const std::vector<std::uint32_t>& loop, const Eigen::Vector3d& normal) {
  double sum = 0;
  double weight = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const std::uint32_t a = loop[i];
    const std::uint32_t b = loop[(i + 1) % loop.size()];
    const double length = (mesh.vertices[b] - mesh.vertices[a]).norm();
    for (const std::uint32_t face : around.of(a)) {
      const Face& f = mesh.faces[face];
      if (std::find(f.begin(), f.end(), b) == f.end()) continue;
      const Eigen::Vector3d face_normal = scaled_face_normal(mesh, face);
      if (const double size = face_normal.stableNorm(); size > 0) {
        sum += length * (face_normal / size).cross(normal).norm();
        weight += length;
      }
    }
  }
  return weight > 0 ? sum / weight : 0;
}

}  // namespace

LoopPlane loop_plane(const TriangleMesh& mesh, const std::vector<std::uint32_t>& loop) {
  const Eigen::Vector3d& origin = mesh.vertices[loop[0]];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d twice_area = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector3d a = mesh.vertices[loop[i]] - origin;
    sum += a;
    twice_area += a.cross(mesh.vertices[loop[(i + 1) % loop.size()]] - origin);
  }
  LoopPlane plane{origin + sum / static_cast<double>(loop.size()), twice_area};
  if (const double length = twice_area.stableNorm(); length > 0) plane.normal /= length;
  return plane;
}

Hole measured(const TriangleMesh& mesh, const BoundaryLoop& loop) {
  const std::size_t count = loop.vertices.size();
  const LoopPlane plane = loop_plane(mesh, loop.vertices);
  Hole hole;
  hole.boundary_edges = loop.closed ? count : count - 1;
  hole.center = plane.point;
  double twice_area = 0;
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d a = mesh.vertices[loop.vertices[i]] - plane.point;
    const Eigen::Vector3d b = mesh.vertices[loop.vertices[(i + 1) % count]] - plane.point;
    if (i < hole.boundary_edges) hole.length += (b - a).norm();
    twice_area += plane.normal.dot(a.cross(b));
    squares += std::pow(plane.normal.dot(a), 2);
  }
  hole.area = twice_area / 2;
  hole.flatness = std::sqrt(squares / static_cast<double>(count));
  return hole;
}

Pieces::Pieces(const TriangleMesh& mesh) : of_vertex_(mesh.vertices.size(), 0), areas_(mesh.faces.size(), 0) {
  const std::vector<std::uint32_t> component = face_components(mesh);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    areas_[component[i]] += scaled_face_normal(mesh, i).norm() / 2;
    for (const std::uint32_t v : mesh.faces[i]) of_vertex_[v] = component[i];
  }
}

bool is_sheet_rim(const Hole& hole, double piece_area) {
  constexpr double sheet_share = 0.25;
  return hole.area >= sheet_share * piece_area;
}

bool is_base(const TriangleMesh& mesh, const VertexFaces& around, const Pieces& pieces,
             const BoundaryLoop& loop, const Hole& hole, double spacing) {
  if (!loop.closed || hole.length < least_base_length_spacings * spacing) return false;
  if (hole.flatness > std::max(spacing, 0.02 * std::sqrt(hole.area))) return false;
  const LoopPlane plane = loop_plane(mesh, loop.vertices);
  if (mean_steepness(mesh, around, loop.vertices, plane.normal) < steep) return false;
  const std::uint32_t piece = pieces.of_vertex(loop.vertices[0]);
  const double tolerance = 3 * std::max(hole.flatness, spacing);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v)
    if (pieces.of_vertex(v) == piece && plane.normal.dot(mesh.vertices[v] - plane.point) > tolerance)
      return false;
  return true;
}

}  // namespace drape::meshing
