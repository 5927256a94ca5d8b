#include "drape/meshing/hole_filling.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "boundary.hpp"
#include "cleaning.hpp"
#include "drape/base/error.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/simplify.hpp"
#include "edge_repair.hpp"
#include "patching.hpp"
#include "vertex_fans.hpp"

namespace drape::meshing {
namespace {

// A loop that spans more than this share of its piece's area bounds an open sheet: it is no hole in it.
constexpr double sheet_share = 0.25;
TriangleMesh repaired(const TriangleMesh& mesh, const FillOptions& options, FillResult& result) {
  Cleaned cleaned{mesh, 0};
  if (options.repair) {
    cleaned = with_joined_borders(mesh);
    result.vertices_joined = cleaned.removed;
    cleaned = without_bad_faces(cleaned.mesh);
    result.bad_faces_removed = cleaned.removed;
    cleaned = with_manifold_edges(cleaned.mesh);
    result.non_manifold_repaired = cleaned.removed;
  }
  cleaned = without_small_components(cleaned.mesh, options.min_component_percent);
  result.components_removed = cleaned.removed;
  return std::move(cleaned.mesh);
}

Hole measured(const TriangleMesh& mesh, const SimpleLoop& loop) {
  Hole hole;
  const std::size_t count = loop.vertices.size();
  hole.boundary_edges = loop.closed ? count : count - 1;
  const Eigen::Vector3d& origin = mesh.vertices[loop.vertices[0]];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d twice_area = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d a = mesh.vertices[loop.vertices[i]] - origin;
    const Eigen::Vector3d b = mesh.vertices[loop.vertices[(i + 1) % count]] - origin;
    sum += a;
    if (i < hole.boundary_edges) hole.length += (b - a).norm();
    twice_area += a.cross(b);
  }
  hole.center = origin + sum / static_cast<double>(count);
  hole.area = twice_area.norm() / 2;
  return hole;
}

// Area of the edge-connected piece that each vertex is in.
std::vector<double> piece_areas(const TriangleMesh& mesh) {
  const std::vector<std::uint32_t> component = face_components(mesh);
  std::vector<double> area(mesh.faces.size(), 0);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    area[component[i]] += scaled_face_normal(mesh, i).norm() / 2;
  std::vector<double> of_vertex(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    for (const std::uint32_t v : mesh.faces[i]) of_vertex[v] = area[component[i]];
  return of_vertex;
}

// Empty if the hole is to be filled, else why it stays open.
std::string why_left(const Hole& hole, const SimpleLoop& loop, double piece_area, double spacing,
                     const FillOptions& options) {
  if (!loop.closed) return "the faces round it are inconsistent: it is no closed loop";
  if (options.keep_outer_border && hole.area >= sheet_share * piece_area)
    return "outer border of an open sheet";
  if (hole.length >= options.max_hole_size_spacings * spacing)
    return "not shorter than max_hole_size_spacings";
  return {};
}

void check(const TriangleMesh& mesh, double spacing) {
  if (const std::string problem = problem_of(mesh); !problem.empty())
    throw input_error("the mesh: {}", problem);
  if (!(spacing > 0) || !std::isfinite(spacing))
    throw input_error("hole filling needs a point spacing; it is {}", spacing);
}

}  // namespace

FillResult fill_holes(const TriangleMesh& mesh, double spacing, const FillOptions& options,
                      const Progress& progress) {
  check(mesh, spacing);
  FillResult result;
  progress.update(0.0, "repairing the mesh");
  const TriangleMesh open = repaired(mesh, options, result);

  const std::vector<SimpleLoop> loops = simple_border_loops(open);
  const std::vector<double> piece_area = piece_areas(open);
  std::vector<std::vector<std::uint32_t>> chosen;
  std::vector<std::size_t> chosen_holes;
  for (const SimpleLoop& loop : loops) {
    Hole hole = measured(open, loop);
    hole.why = why_left(hole, loop, piece_area[loop.vertices[0]], spacing, options);
    if (hole.why.empty()) {
      chosen.push_back(loop.vertices);
      chosen_holes.push_back(result.holes.size());
    }
    result.holes.push_back(std::move(hole));
  }
  Patched patched = with_patches(open, chosen, PatchStyle::smooth, progress.part(0.1, 0.8));
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    Hole& hole = result.holes[chosen_holes[i]];
    hole.filled = patched.holes[i].faces > 0;
    hole.faces_added = patched.holes[i].faces;
    hole.why = hole.filled ? "shorter than max_hole_size_spacings; " + patched.holes[i].how
                           : "the faces round it are inconsistent: a boundary edge has not exactly one face";
  }
  result.self_intersections = patched.crossings;
  result.mesh = std::move(patched.mesh);
  if (options.repair) {
    Cleaned parted = with_parted_fans(result.mesh);
    result.non_manifold_repaired += parted.removed;
    result.mesh = std::move(parted.mesh);
  }
  progress.update(0.9, "simplifying");
  result.simplified = options.simplify_triangles == 0
                          ? result.mesh
                          : simplified(result.mesh, static_cast<std::size_t>(options.simplify_triangles));
  progress.update(1.0);
  return result;
}

}  // namespace drape::meshing
