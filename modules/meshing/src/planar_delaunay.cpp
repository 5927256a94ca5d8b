#include "planar_delaunay.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace drape::meshing {

std::vector<Face> delaunay_faces(const std::vector<PlanarSite>& sites) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
  using Delaunay = CGAL::Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase>>;
  std::vector<std::pair<Kernel::Point_2, std::uint32_t>> places;
  places.reserve(sites.size());
  for (const PlanarSite& site : sites) places.emplace_back(Kernel::Point_2(site.x, site.y), site.index);
  const Delaunay triangulation(places.begin(), places.end());
  std::vector<Face> faces;
  faces.reserve(triangulation.number_of_faces());
  for (auto f = triangulation.finite_faces_begin(); f != triangulation.finite_faces_end(); ++f)
    faces.push_back({f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()});
  return faces;
}

}  // namespace drape::meshing
