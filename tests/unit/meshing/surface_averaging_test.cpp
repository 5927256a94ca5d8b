// What averaging leaves of noise, and what it takes of a shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "drape/base/random.hpp"
#include "range_denoising.hpp"

namespace drape::meshing {
namespace {

constexpr int side = 160;
constexpr float noise = 0.7F;  // spacings

// Root mean square off the truth, away from the borders.
template <class Depth>
double error_of_denoised(Depth depth) {
  RangeGrid grid{side, side, {}};
  std::vector<RangeSample> samples;
  Rng random(5);
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      grid.cells.push_back(static_cast<std::int32_t>(samples.size()));
      RangeSample sample;
      sample.column = static_cast<float>(column);
      sample.row = static_cast<float>(row);
      sample.depth = depth(sample.column) + noise * static_cast<float>(random.normal());
      samples.push_back(sample);
    }
  const Denoised result = denoised(samples, SampleNeighbors(grid), Sight{}, 6);
  EXPECT_NEAR(result.noise, noise, 0.15);
  double squares = 0;
  double count = 0;
  constexpr float margin = 16;
  for (const RangeSample& s : result.samples) {
    if (std::min(s.column, s.row) < margin || std::max(s.column, s.row) >= side - margin) continue;
    squares += std::pow(static_cast<double>(s.depth - depth(s.column)), 2);
    ++count;
  }
  return std::sqrt(squares / count);
}

// Far neighbours count where the surface is flat, and do not where it turns.
TEST(SurfaceAveraging, ReachesAsFarAsTheShapeAllows) {
  const double flat = error_of_denoised([](float x) { return 500 + 0.3F * x; });
  const double waves = error_of_denoised([](float x) { return 500 + 3 * std::sin(x / 5); });
  EXPECT_LT(flat, 0.078);
  EXPECT_LT(waves, 0.148);
}

}  // namespace
}  // namespace drape::meshing
