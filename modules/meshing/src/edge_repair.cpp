#include "edge_repair.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>

#include <vector>

#include "drape/geometry/mesh_topology.hpp"

namespace drape::meshing {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
namespace PMP = CGAL::Polygon_mesh_processing;

// Notes which vertex each appended one is a copy of.
struct CopyNotes : PMP::Default_orientation_visitor {
  std::vector<std::size_t>* original;
  void duplicated_vertex(std::size_t v, std::size_t copy) {
    if (original->size() <= copy) original->resize(copy + 1);
    (*original)[copy] = v;
  }
};

template <class Attribute>
void extend(std::vector<Attribute>& values, const std::vector<std::size_t>& original) {
  if (values.empty()) return;
  for (std::size_t v = values.size(); v < original.size(); ++v)
    values.push_back(Attribute(values[original[v]]));
}

}  // namespace

Cleaned with_manifold_edges(const TriangleMesh& mesh) {
  const MeshTopology topology = mesh_topology(mesh);
  const std::size_t wrong = topology.non_manifold_edges + topology.inconsistent_edges;
  if (wrong == 0) return {mesh, 0};
  std::vector<Point> points;
  for (const Eigen::Vector3d& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::vector<std::size_t>> polygons;
  for (const Face& f : mesh.faces) polygons.push_back({f[0], f[1], f[2]});
  std::vector<std::size_t> original(points.size());
  CopyNotes notes;
  notes.original = &original;
  PMP::orient_polygon_soup(points, polygons, CGAL::parameters::visitor(notes));
  original.resize(points.size());

  TriangleMesh repaired = mesh;
  extend(repaired.vertices, original);
  extend(repaired.normals, original);
  extend(repaired.colors, original);
  extend(repaired.intensities, original);
  extend(repaired.confidences, original);
  for (std::size_t i = 0; i < polygons.size(); ++i)
    repaired.faces[i] = {static_cast<std::uint32_t>(polygons[i][0]),
                         static_cast<std::uint32_t>(polygons[i][1]),
                         static_cast<std::uint32_t>(polygons[i][2])};
  return {repaired, wrong};
}

}  // namespace drape::meshing
