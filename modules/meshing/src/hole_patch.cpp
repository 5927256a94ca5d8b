#include "hole_patch.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "drape/base/random.hpp"

namespace drape::meshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Vertex = Mesh::Vertex_index;
using HalfEdge = Mesh::Halfedge_index;
namespace PMP = CGAL::Polygon_mesh_processing;

// Beyond this many edges CGAL's second, cubic search takes minutes; its first (over the edges of a 3D
// Delaunay triangulation) finds a patch in nearly all cases.
constexpr std::size_t most_edges_for_cubic_search = 200;

Vertex vertex(std::size_t i) {
  return Vertex(static_cast<Vertex::size_type>(i));
}

// Among equally good triangulations CGAL takes one by the addresses of its cells, and a border on a regular
// lattice has many. The patch is sought on points that are off by an invisible amount, so that one is best
// (equal areas differ by the square of that amount).
Mesh surface_of(const HoleRegion& region) {
  double length = 0;
  for (std::size_t i = 0; i < region.loop; ++i)
    length += (region.points[(i + 1) % region.loop] - region.points[i]).norm();
  const double most = 1e-5 * length / static_cast<double>(region.loop);
  Mesh mesh;
  Rng rng(0);
  for (const Eigen::Vector3d& p : region.points) {
    const double x = p.x() + rng.uniform(-most, most);
    const double y = p.y() + rng.uniform(-most, most);
    mesh.add_vertex({x, y, p.z() + rng.uniform(-most, most)});
  }
  for (const Face& f : region.faces) mesh.add_face(vertex(f[0]), vertex(f[1]), vertex(f[2]));
  return mesh;
}

// Makes the border run from each boundary vertex to the next one, also where several borders touch. Returns
// one of its half-edges, or none where a boundary edge is no border of the mesh.
HalfEdge linked_border(Mesh& mesh, std::size_t loop) {
  std::vector<HalfEdge> border;
  for (std::size_t i = 0; i < loop; ++i) {
    const HalfEdge h = mesh.halfedge(vertex(i), vertex((i + 1) % loop));
    if (h == Mesh::null_halfedge() || !mesh.is_border(h)) return Mesh::null_halfedge();
    border.push_back(h);
  }
  for (std::size_t i = 0; i < loop; ++i) {
    const HalfEdge here = border[i];
    const HalfEdge wanted = border[(i + 1) % loop];
    const HalfEdge instead = mesh.next(here);
    if (instead == wanted) continue;
    // The two other borders that meet here take what is left over.
    mesh.set_next(mesh.prev(wanted), instead);
    mesh.set_next(here, wanted);
  }
  for (std::size_t i = 0; i < loop; ++i) mesh.set_halfedge(vertex((i + 1) % loop), border[i]);
  return border.front();
}

Patch patch_of(const Mesh& mesh, const std::vector<Mesh::Face_index>& faces, const HoleRegion& region) {
  Patch patch;
  const auto first_new = region.points.size();
  for (std::size_t v = first_new; v < mesh.num_vertices(); ++v) {
    const Kernel::Point_3& p = mesh.point(vertex(v));
    patch.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto f : faces) {
    Face face{};
    std::size_t k = 0;
    for (const Vertex v : mesh.vertices_around_face(mesh.halfedge(f)))
      face[k++] =
          static_cast<std::uint32_t>(v.idx() < first_new ? v.idx() : v.idx() - first_new + region.loop);
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    patch.faces.push_back(face);
  }
  std::sort(patch.faces.begin(), patch.faces.end());  // CGAL's order may differ from call to call
  return patch;
}

}  // namespace

std::optional<Patch> triangulated_patch(const HoleRegion& region, Smoothness smoothness, double density) {
  CGAL::get_default_random() = CGAL::Random(0);  // CGAL seeds it by the time of day
  Mesh mesh = surface_of(region);
  const HalfEdge border = linked_border(mesh, region.loop);
  if (border == Mesh::null_halfedge()) return std::nullopt;

  std::vector<Mesh::Face_index> faces;
  PMP::triangulate_hole(
      mesh, border, std::back_inserter(faces),
      CGAL::parameters::do_not_use_cubic_algorithm(region.loop > most_edges_for_cubic_search));
  if (faces.empty()) return std::nullopt;
  if (smoothness != Smoothness::plain) {
    std::vector<Mesh::Face_index> added;
    std::vector<Vertex> vertices;
    PMP::refine(mesh, faces, std::back_inserter(added), std::back_inserter(vertices),
                CGAL::parameters::density_control_factor(std::sqrt(2.0) * density));
    faces.insert(faces.end(), added.begin(), added.end());
    if (smoothness == Smoothness::faired && !vertices.empty() &&
        !PMP::fair(mesh, vertices, CGAL::parameters::fairing_continuity(1)))
      return std::nullopt;
  }
  return patch_of(mesh, faces, region);
}

}  // namespace drape::meshing
