#include "grid_delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "planar_delaunay.hpp"

namespace drape::meshing {
namespace {

std::vector<Face> lattice_triangles(const RangeScan& scan) {
  const RangeGrid& grid = *scan.grid;
  std::vector<PlanarSite> sites;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (const std::int32_t index = grid.at(row, column);
          index != RangeGrid::missing && scan.cloud.positions[static_cast<std::size_t>(index)].allFinite())
        sites.push_back(
            {static_cast<double>(column), static_cast<double>(row), static_cast<std::uint32_t>(index)});
  return delaunay_faces(sites);
}

// For each face of one lattice orientation: positive where it faces the scanner.
double facing(const TriangleMesh& mesh, std::size_t face, const RangeScan& scan) {
  const Eigen::Vector3d normal = scaled_face_normal(mesh, face);
  const Face& f = mesh.faces[face];
  if (scan.view.kind != ScanView::Kind::unknown)
    return normal.dot(
        scan.view.towards_scanner((mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3));
  if (scan.cloud.normals.empty()) return 0;
  return normal.dot(
      (scan.cloud.normals[f[0]] + scan.cloud.normals[f[1]] + scan.cloud.normals[f[2]]).cast<double>());
}

bool spans_depth_step(const TriangleMesh& mesh, std::size_t face, const ScanView& view, double longest_edge,
                      double least_cosine) {
  const Face& f = mesh.faces[face];
  for (std::size_t k = 0; k < 3; ++k)
    if ((mesh.vertices[f[(k + 1) % 3]] - mesh.vertices[f[k]]).norm() > longest_edge) return true;
  const Eigen::Vector3d normal = scaled_face_normal(mesh, face);
  if (normal.squaredNorm() == 0) return true;
  if (view.kind == ScanView::Kind::unknown) return false;
  return std::abs(normal.normalized().dot(view.towards_scanner(mesh.vertices[f[0]]))) < least_cosine;
}

}  // namespace

TriangleMesh grid_mesh(const RangeScan& scan, double longest_edge, double max_incidence_deg) {
  TriangleMesh mesh;
  mesh.vertices = scan.cloud.positions;
  mesh.colors = scan.cloud.colors;
  mesh.intensities = scan.cloud.intensities;
  mesh.confidences = scan.cloud.confidences;
  mesh.faces = lattice_triangles(scan);

  const double least_cosine = std::cos(max_incidence_deg * std::numbers::pi / 180);
  std::vector<std::uint8_t> keep(mesh.faces.size());
  double sum = 0;
  for (std::size_t i = 0; i < keep.size(); ++i) {
    keep[i] = spans_depth_step(mesh, i, scan.view, longest_edge, least_cosine) ? 0 : 1;
    if (keep[i]) sum += facing(mesh, i, scan);
  }
  if (sum < 0)
    for (Face& f : mesh.faces) std::swap(f[1], f[2]);
  return with_faces(mesh, keep);
}

}  // namespace drape::meshing
