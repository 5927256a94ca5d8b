// A plane over a loop.
#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <set>
#include <vector>

#include "hole_patch.hpp"

namespace drape::meshing {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel,
                                               CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

// The faces that are reached from outside without crossing the border.
std::set<Triangulation::Face_handle> outer_faces(const Triangulation& triangulation) {
  std::vector<Triangulation::Face_handle> queue{triangulation.infinite_face()};
  std::set<Triangulation::Face_handle> outside{queue.front()};
  while (!queue.empty()) {
    const Triangulation::Face_handle face = queue.back();
    queue.pop_back();
    for (int k = 0; k < 3; ++k)
      if (!face->is_constrained(k) && outside.insert(face->neighbor(k)).second)
        queue.push_back(face->neighbor(k));
  }
  return outside;
}

}  // namespace

std::optional<Patch> planar_patch(const std::vector<Eigen::Vector3d>& loop) {
  const std::vector<Eigen::Vector2d> flat = flattened(loop);
  Triangulation triangulation;
  std::vector<Triangulation::Vertex_handle> corners;
  for (std::uint32_t i = 0; i < flat.size(); ++i) {
    corners.push_back(triangulation.insert({flat[i].x(), flat[i].y()}));
    corners.back()->info() = i;
  }
  if (triangulation.number_of_vertices() != loop.size()) return std::nullopt;
  try {
    for (std::size_t i = 0; i < corners.size(); ++i)
      triangulation.insert_constraint(corners[i], corners[(i + 1) % corners.size()]);
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    return std::nullopt;  // seen along its normal, the border crosses itself
  }
  Patch patch;
  const std::set<Triangulation::Face_handle> outside = outer_faces(triangulation);
  for (const Triangulation::Face_handle f : triangulation.finite_face_handles()) {
    if (outside.count(f) != 0) continue;
    Face face{f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info()};
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    patch.faces.push_back(face);
  }
  std::sort(patch.faces.begin(), patch.faces.end());
  return patch;
}

}  // namespace drape::meshing
