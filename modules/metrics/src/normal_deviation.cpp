#include "drape/metrics/normal_deviation.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "drape/base/error.hpp"
#include "drape/base/parallel.hpp"
#include "drape/metrics/surface_samples.hpp"
#include "drape/metrics/surface_tree.hpp"

namespace drape::metrics {

NormalDeviation normal_deviation(const TriangleMesh& from, const TriangleMesh& to, std::size_t samples,
                                 std::uint64_t seed) {
  const std::vector<SurfaceSample> points = surface_samples(from, samples, seed);
  if (points.empty()) throw input_error("cannot compare the normals of a mesh without area or samples");
  const SurfaceTree tree(to);
  std::vector<double> angles_deg(points.size());
  parallel_for(points.size(), 512, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d here = scaled_face_normal(from, points[i].face);
      const Eigen::Vector3d there = scaled_face_normal(to, tree.closest(points[i].point).face);
      // By the tangent: the cosine alone loses half the digits of a small angle.
      angles_deg[i] = std::atan2(here.cross(there).norm(), here.dot(there)) * 180 / std::numbers::pi;
    }
  });
  NormalDeviation deviation;
  const auto flipped = std::count_if(angles_deg.begin(), angles_deg.end(), [](double a) { return a > 90; });
  deviation.flipped_percent = 100.0 * static_cast<double>(flipped) / static_cast<double>(points.size());
  deviation.angle_deg = distribution(std::move(angles_deg));
  return deviation;
}

}  // namespace drape::metrics
