#include "range_denoising.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "surface_averaging.hpp"

namespace drape::meshing {
namespace {

constexpr std::size_t most_neighbors = 24;

// Depths round a sample, relative to its own; all lengths in spacings.
struct Surroundings {
  std::size_t count = 0;
  std::array<float, most_neighbors + 1> x{};
  std::array<float, most_neighbors + 1> y{};
  std::array<float, most_neighbors + 1> z{};
  std::array<float, most_neighbors + 1> weight{};

  void add(float dx, float dy, float dz, float w) {
    x[count] = dx;
    y[count] = dy;
    z[count] = dz;
    weight[count++] = w;
  }
};

// depth = at + slope_x x + slope_y y
struct Plane {
  float at = 0;
  float slope_x = 0;
  float slope_y = 0;

  [[nodiscard]] float cosine() const { return 1 / std::sqrt(1 + slope_x * slope_x + slope_y * slope_y); }
};

float biweight(float residual, float limit) {
  const float r = residual / limit;
  const float rest = 1 - r * r;
  return rest > 0 ? rest * rest : 0.0F;
}

Plane fitted_plane(const Surroundings& s) {
  float sw = 0, sx = 0, sy = 0, sz = 0, sxx = 0, sxy = 0, syy = 0, sxz = 0, syz = 0;
  for (std::size_t i = 0; i < s.count; ++i) {
    const float w = s.weight[i];
    const float wx = w * s.x[i];
    const float wy = w * s.y[i];
    sw += w;
    sx += wx;
    sy += wy;
    sz += w * s.z[i];
    sxx += wx * s.x[i];
    sxy += wx * s.y[i];
    syy += wy * s.y[i];
    sxz += wx * s.z[i];
    syz += wy * s.z[i];
  }
  if (!(sw > 0)) return {};
  // About the mean; the ridge leaves slopes that the neighbours do not show at 0.
  const float mx = sx / sw;
  const float my = sy / sw;
  const float mz = sz / sw;
  const float ridge = 1e-4F * sw;
  const float cxx = sxx - mx * sx + ridge;
  const float cxy = sxy - mx * sy;
  const float cyy = syy - my * sy + ridge;
  const float cxz = sxz - mx * sz;
  const float cyz = syz - my * sz;
  const float determinant = cxx * cyy - cxy * cxy;
  const float a = (cxz * cyy - cyz * cxy) / determinant;
  const float b = (cyz * cxx - cxz * cxy) / determinant;
  return {mz - a * mx - b * my, a, b};
}

// Neighbours far off in depth start with little weight, so that the first plane is not one across a step.
Surroundings surroundings_of(const std::vector<RangeSample>& samples, std::span<const std::uint32_t> around,
                             std::size_t center, const Sight& sight, float longest_edge_spacings) {
  const RangeSample& c = samples[center];
  const auto per_pixel = static_cast<float>(1 / sight.pixels_per_spacing);
  const auto per_length = static_cast<float>(1 / sight.spacing_at(static_cast<double>(c.depth)));
  Surroundings s;
  for (const std::uint32_t i : around) {
    const RangeSample& n = samples[i];
    if (!seen(n)) continue;
    const float dx = (n.column - c.column) * per_pixel;
    const float dy = (n.row - c.row) * per_pixel;
    const float dz = (n.depth - c.depth) * per_length;
    const float w = biweight(dz, longest_edge_spacings);
    if (w > 0 && s.count < most_neighbors) s.add(dx, dy, dz, w);
  }
  return s;
}

// Deviation of the noise across the surface, in spacings, from the samples' distances to planes through
// their neighbours: a few thousand tell.
float noise_of(const std::vector<RangeSample>& samples, const SampleNeighbors& neighbors, const Sight& sight,
               float longest_edge_spacings) {
  std::vector<float> residuals;
  neighbors.for_some([&](std::size_t i, std::span<const std::uint32_t> around) {
    if (!seen(samples[i])) return;
    const Surroundings s = surroundings_of(samples, around, i, sight, longest_edge_spacings);
    if (s.count < 5) return;
    const Plane plane = fitted_plane(s);
    const auto count = static_cast<float>(s.count);
    residuals.push_back(std::abs(plane.at) * plane.cosine() * std::sqrt(count / (count + 1)));
  });
  return deviation_of(std::move(residuals));
}

Plane robust_plane(Surroundings& s, float noise) {
  constexpr int reweightings = 3;
  Plane plane = fitted_plane(s);
  for (int round = 0; round < reweightings; ++round) {
    // Across the surface the noise is the same at any incidence; along the ray it is 1 / cosine of that.
    const float limit = 3 * noise / plane.cosine();
    for (std::size_t i = 0; i < s.count; ++i)
      s.weight[i] = biweight(s.z[i] - (plane.at + plane.slope_x * s.x[i] + plane.slope_y * s.y[i]), limit);
    plane = fitted_plane(s);
  }
  return plane;
}

}  // namespace

Denoised denoised(const std::vector<RangeSample>& samples, const SampleNeighbors& neighbors,
                  const Sight& sight, double longest_edge_spacings) {
  const auto longest = static_cast<float>(longest_edge_spacings);
  constexpr float least_noise_spacings = 0.01F;
  const float noise = std::max(least_noise_spacings, noise_of(samples, neighbors, sight, longest));
  std::vector<RangeSample> result = samples;
  neighbors.for_all([&](std::size_t i, std::span<const std::uint32_t> around) {
    if (!seen(samples[i]) || around.empty()) return;
    Surroundings s = surroundings_of(samples, around, i, sight, longest);
    s.add(0, 0, 0, 1);
    const Plane plane = robust_plane(s, noise);
    result[i].depth += plane.at * static_cast<float>(sight.spacing_at(static_cast<double>(samples[i].depth)));
    result[i].slope_x = plane.slope_x;
    result[i].slope_y = plane.slope_y;
  });
  return {averaged_over_surfaces(std::move(result), neighbors, sight, noise), noise};
}

}  // namespace drape::meshing
