#include "drape/metrics/surface_samples.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/error.hpp"
#include "drape/base/random.hpp"

namespace drape::metrics {

std::vector<SurfaceSample> surface_samples(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
  if (const std::string problem = problem_of(mesh); !problem.empty())
    throw input_error("cannot sample this mesh: {}", problem);
  std::vector<double> area_up_to;
  area_up_to.reserve(mesh.faces.size());
  double area = 0;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i)
    area_up_to.push_back(area += scaled_face_normal(mesh, i).norm());
  if (!(area > 0)) return {};

  std::vector<SurfaceSample> samples;
  samples.reserve(count);
  Rng rng(seed);
  for (std::size_t i = 0; i < count; ++i) {
    // One sample in each of `count` equal shares of the area: uniform, and more even than independent draws.
    const double at = area * (static_cast<double>(i) + rng.uniform()) / static_cast<double>(count);
    const auto chosen = std::min(std::upper_bound(area_up_to.begin(), area_up_to.end(), at),
                                 std::lower_bound(area_up_to.begin(), area_up_to.end(), area));
    const auto face = static_cast<std::uint32_t>(chosen - area_up_to.begin());
    // Osada et al., "Shape distributions", 2002, equation 1.
    const double root = std::sqrt(rng.uniform());
    const double across = rng.uniform();
    const Face& f = mesh.faces[face];
    samples.push_back({(1 - root) * mesh.vertices[f[0]] + root * (1 - across) * mesh.vertices[f[1]] +
                           root * across * mesh.vertices[f[2]],
                       face});
  }
  return samples;
}

}  // namespace drape::metrics
