#include "shading_cue.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "drape/rendering/renderer.hpp"
#include "stencil_level.hpp"

namespace drape::alignment {
namespace {

constexpr double object_px = 160;  // the object's size in the pictures that are compared
constexpr int least_pixels = 200;
constexpr double independent_pixels = 200;  // of the thousands that there are: neighbours share their error
constexpr double least_evidence = 8;        // of log likelihood, for overruling the outline's order

using Harmonics = Eigen::Matrix<double, 9, 1>;

Harmonics harmonics(const Eigen::Vector3d& n) {
  Harmonics h;
  h << 1, n.x(), n.y(), n.z(), n.x() * n.y(), n.y() * n.z(), n.z() * n.x(), n.x() * n.x() - n.y() * n.y(),
      3 * n.z() * n.z() - 1;
  return h;
}

double brightness(const Image8& photo, int x, int y) {
  return (photo.at(x, y, 0) + photo.at(x, y, 1) + photo.at(x, y, 2)) / 765.0;
}

// Log likelihood of the fit: -(n / 2) ln(1 - R^2). 0 where too little is seen.
double shading_evidence(const TriangleMesh& mesh, rendering::Renderer& renderer, const Image8& photo,
                        const Image8& stencil, const Camera& camera) {
  const double factor = std::min(1.0, object_px / object_extent(stencil));
  const Camera small = camera.resized(std::max(1, static_cast<int>(camera.width * factor)),
                                      std::max(1, static_cast<int>(camera.height * factor)));
  const rendering::DepthMap seen = renderer.depth_map(small);
  Eigen::Matrix<double, 9, 9> matrix = Eigen::Matrix<double, 9, 9>::Identity() * 1e-6;
  Harmonics vector = Harmonics::Zero();
  double sum = 0;
  double squares = 0;
  int count = 0;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const std::int32_t face = seen.faces.at(x, y);
      const int u = static_cast<int>((x + 0.5) * camera.width / small.width);
      const int v = static_cast<int>((y + 0.5) * camera.height / small.height);
      if (face == rendering::DepthMap::no_face || stencil.at(u, v) != stencil::object) continue;
      Eigen::Vector3d normal = small.camera_from_world.linear() *
                               scaled_face_normal(mesh, static_cast<std::size_t>(face)).normalized();
      if (normal.z() > 0) normal = -normal;  // whichever side of a face is seen looks at the camera
      const Harmonics h = harmonics(normal);
      const double value = brightness(photo, u, v);
      matrix += h * h.transpose();
      vector += value * h;
      sum += value;
      squares += value * value;
      ++count;
    }
  const double spread = squares - sum * sum / std::max(1, count);
  if (count < least_pixels || !(spread > 1e-6 * count)) return 0;
  const double left = std::max(squares - vector.dot(matrix.ldlt().solve(vector)), 1e-6 * spread);
  return -0.5 * independent_pixels * std::log(std::min(1.0, left / spread));
}

}  // namespace

std::size_t best_shaded(const TriangleMesh& mesh, const Image8& photo, const Image8& stencil,
                        const std::vector<Camera>& cameras) {
  rendering::Renderer renderer(mesh);
  std::vector<double> evidence;
  for (const Camera& camera : cameras)
    evidence.push_back(shading_evidence(mesh, renderer, photo, stencil, camera));
  const auto best = std::max_element(evidence.begin(), evidence.end());
  if (best == evidence.end() || *best < evidence.front() + least_evidence) return 0;
  return static_cast<std::size_t>(best - evidence.begin());
}

}  // namespace drape::alignment
