#include "drape/meshing/mesh_quality.hpp"

#include "drape/base/error.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "vertex_fans.hpp"

namespace drape::meshing {

MeshQuality mesh_quality(const TriangleMesh& mesh) {
  if (const std::string problem = problem_of(mesh); !problem.empty())
    throw input_error("the mesh: {}", problem);
  const MeshTopology topology = mesh_topology(mesh);
  MeshQuality quality;
  quality.vertices = mesh.vertices.size();
  quality.faces = mesh.faces.size();
  quality.components = topology.components;
  quality.boundary_loops = topology.boundary_loops;
  quality.borders = topology.borders;
  quality.boundary_edges = topology.boundary_edges;
  quality.non_manifold_edges = topology.non_manifold_edges;
  quality.non_manifold_vertices = non_manifold_vertex_count(mesh);
  quality.inconsistent_edges = topology.inconsistent_edges;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    if (scaled_face_normal(mesh, i).stableNorm() == 0) ++quality.degenerate_faces;
  quality.self_intersections = self_intersecting_pairs(mesh).size();
  // Euler and Poincare: V - E + F = 2 c - 2 g - b.
  if (quality.manifold())
    quality.genus = (2 * static_cast<long>(topology.components) - static_cast<long>(topology.boundary_loops) -
                     static_cast<long>(topology.euler_characteristic)) /
                    2;
  if (quality.closed() && !mesh.empty()) quality.volume = signed_volume(mesh);
  quality.area = surface_area(mesh);
  quality.median_edge = median_edge_length(mesh);
  return quality;
}

}  // namespace drape::meshing
