// The last step of an alignment by a clean stencil.
#include "pixel_fit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "bodies.hpp"
#include "stencil_evidence.hpp"

namespace drape::alignment {
namespace {

TEST(IntervalLikelihood, DerivativesAreThoseOfFiniteDifferences) {
  constexpr double sigma = 0.3;
  const auto logarithm = [&](double low, double high) {
    return std::log(
        (std::erf(high / sigma / std::numbers::sqrt2) - std::erf(low / sigma / std::numbers::sqrt2)) / 2);
  };
  constexpr double h = 1e-4;
  for (const double low : {-0.9, -0.5, -0.1, 0.2, 0.6}) {
    const double high = low + 1;
    const IntervalLikelihood at = interval_likelihood(low, high, sigma);
    const double up = logarithm(low - h, high - h);
    const double down = logarithm(low + h, high + h);
    EXPECT_NEAR(at.slope, (up - down) / (2 * h), 1e-4) << low;
    EXPECT_NEAR(at.curvature, -(up - 2 * logarithm(low, high) + down) / (h * h), 1e-3) << low;
  }
}

TEST(IntervalLikelihood, FarAwayTheNearerEndCounts) {
  for (const double sign : {1.0, -1.0}) {
    const IntervalLikelihood far = interval_likelihood(sign > 0 ? 3 : -4, sign > 0 ? 4 : -3, 0.02);
    EXPECT_NEAR(far.slope, sign * 3 / (0.02 * 0.02), 200);
    EXPECT_NEAR(far.curvature, 1 / (0.02 * 0.02), 50);
  }
}

TEST(OutlineDrawing, CrossesBetweenEachTwoPixelsThatDiffer) {
  const UnitSphere sphere = unit_sphere(knobbed_brick());
  const OutlineMesh mesh = outline_mesh(knobbed_brick(), sphere);
  const Camera camera = view_of({20, 70, 130}).resized(640, 480);
  const PhotoPlane plane(640, 480, std::nullopt);
  const OutlinePose pose = pose_of(camera, sphere, plane.principal_px()).value();
  const StencilLevel level = stencil_level(stencil_of(knobbed_brick(), camera), plane, 1, 5);
  OutlineDrawing drawing;
  drawing.draw(mesh, pose, level.window);
  const auto crossings = drawing.crossings(mesh, pose);
  EXPECT_GE(crossings.size(), level.contour.size());
  for (const PixelCrossing& crossing : crossings) {
    // Where it says that it is, of the point that it says.
    EXPECT_LT((level.window.from_photo(pose.place(crossing.turned)) - crossing.at).norm(), 1e-6);
    const double along = crossing.at[crossing.in_row ? 0 : 1];
    EXPECT_GE(along, crossing.before + 0.5);
    EXPECT_LE(along, crossing.before + 1.5);
    EXPECT_EQ(crossing.outward[crossing.in_row ? 0 : 1] > 0, crossing.object_first);
  }
}

TEST(PixelFit, MeetsWhatEachPixelSays) {
  const UnitSphere sphere = unit_sphere(knobbed_brick());
  const OutlineMesh mesh = outline_mesh(knobbed_brick(), sphere);
  const Camera camera = view_of({290, 110, 250}).resized(640, 480);
  const PhotoPlane plane(640, 480, std::nullopt);
  const OutlinePose truth = pose_of(camera, sphere, plane.principal_px()).value();
  const StencilEvidence evidence(stencil_of(knobbed_brick(), camera), plane);
  LensPrior lens;
  lens.photo_width_px = 640;
  PoseVector off;
  off << 0.003, -0.002, 0.003, 0.2, 0.2, -0.3, 0.005, 0, 0;
  RefinedPose start;
  start.pose = moved(truth, off);
  const RefinedPose fitted = fit_to_pixels(mesh, start, evidence, lens);
  EXPECT_LT(angle_between(fitted.pose.rotation, truth.rotation) * 180 / std::numbers::pi, 0.03);
  EXPECT_GT(fitted.agreement.overlap, 0.999);
}

}  // namespace
}  // namespace drape::alignment
