#include "scale_space.hpp"

#include <CGAL/Default_diagonalize_traits.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Scale_space_reconstruction_3/Advancing_front_mesher.h>
#include <CGAL/Scale_space_reconstruction_3/Weighted_PCA_smoother.h>
#include <CGAL/Scale_space_surface_reconstruction_3.h>

#include <vector>

namespace drape::meshing {

TriangleMesh scale_space_mesh(const PointCloud& samples, double radius, double longest_edge) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  namespace scale_space = CGAL::Scale_space_reconstruction_3;
  std::vector<Kernel::Point_3> points;
  points.reserve(samples.size());
  // About the first sample: squares of large coordinates would lose the digits that tell samples apart.
  for (const Eigen::Vector3d& p : samples.positions) {
    const Eigen::Vector3d near = p - samples.positions.front();
    points.emplace_back(near.x(), near.y(), near.z());
  }
  constexpr int smoothings = 4;
  CGAL::Scale_space_surface_reconstruction_3<Kernel> reconstruction(points.begin(), points.end());
  reconstruction.increase_scale(
      smoothings, scale_space::Weighted_PCA_smoother<Kernel, CGAL::Default_diagonalize_traits<double, 3>,
                                                     CGAL::Sequential_tag>(radius * radius));
  reconstruction.reconstruct_surface(scale_space::Advancing_front_mesher<Kernel>(longest_edge));
  TriangleMesh mesh;
  mesh.vertices = samples.positions;
  for (auto facet = reconstruction.facets_begin(); facet != reconstruction.facets_end(); ++facet)
    mesh.faces.push_back({static_cast<std::uint32_t>((*facet)[0]), static_cast<std::uint32_t>((*facet)[1]),
                          static_cast<std::uint32_t>((*facet)[2])});
  return mesh;
}

}  // namespace drape::meshing
