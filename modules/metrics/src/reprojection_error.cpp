#include "drape/metrics/reprojection_error.hpp"

#include <vector>

#include "drape/base/error.hpp"

namespace drape::metrics {
namespace {

bool sees(const Camera& camera, const Camera::Projected& projected) {
  return projected.pixel.allFinite() &&
         (camera.projection == Camera::Projection::orthographic || projected.depth > 0);
}

}  // namespace

ReprojectionError reprojection_error(std::span<const Eigen::Vector3d> points, const Camera& found,
                                     const Camera& truth) {
  if (found.width <= 0 || found.height <= 0 || truth.width <= 0 || truth.height <= 0)
    throw input_error("cannot compare cameras: one of them has no pixels");
  const Camera resized = found.resized(truth.width, truth.height);
  ReprojectionError error;
  std::vector<double> distances_px;
  distances_px.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    const Camera::Projected expected = truth.project(point);
    if (!sees(truth, expected)) continue;
    const Camera::Projected actual = resized.project(point);
    if (sees(resized, actual))
      distances_px.push_back((actual.pixel - expected.pixel).norm());
    else
      ++error.behind_found;
  }
  if (distances_px.empty() && error.behind_found == 0)
    throw input_error("cannot measure a reprojection error: no point lies in front of the true camera");
  error.distance_px = distribution(std::move(distances_px));
  return error;
}

}  // namespace drape::metrics
