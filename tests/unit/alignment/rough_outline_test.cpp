// Stencils whose outline is rough, and what the photo's inside makes up for.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "bodies.hpp"
#include "drape/alignment/align.hpp"
#include "drape/rendering/renderer.hpp"
#include "noisy_outline.hpp"
#include "outline_misfit.hpp"
#include "photo_plane.hpp"
#include "pose_verdict.hpp"
#include "shading_refinement.hpp"
#include "surface_light.hpp"
#include "surface_view.hpp"

namespace drape::alignment {
namespace {

TEST(RoughOutline, ThePhotosInsideMakesUpForIt) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = view_of({200, 80, 100}).resized(640, 480);
  const Image8 stencil = wavy(stencil_of(mesh, truth), 5);
  const Image8 photo = lit_photo(mesh, truth);
  PhotoEvidence evidence{stencil};
  const Alignment by_outline = align_photo(mesh, evidence, {}, 1, {});
  evidence.photo = &photo;
  const Alignment by_both = align_photo(mesh, evidence, {}, 1, {});
  ASSERT_TRUE(by_outline.outline.has_value() && by_both.outline.has_value());
  EXPECT_GT(by_outline.outline->noise_px, 0.5);
  EXPECT_FALSE(by_outline.outline->by_photo);
  EXPECT_TRUE(by_both.outline->by_photo);
  EXPECT_LT(rotation_between_deg(by_both.camera, truth), 0.5);
  EXPECT_LT(rotation_between_deg(by_both.camera, truth), rotation_between_deg(by_outline.camera, truth));
  EXPECT_LT(by_both.outline->rotation_deg, by_outline.outline->rotation_deg);
}

TEST(RoughOutline, ASmoothOneIsLeftToItself) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = view_of({290, 110, 250}).resized(640, 480);
  const Image8 stencil = stencil_of(mesh, truth);
  const Image8 photo = lit_photo(mesh, truth);
  PhotoEvidence evidence{stencil};
  const Alignment alone = align_photo(mesh, evidence, {}, 1, {});
  evidence.photo = &photo;
  const Alignment with_photo = align_photo(mesh, evidence, {}, 1, {});
  ASSERT_TRUE(alone.outline.has_value());
  EXPECT_LT(alone.outline->noise_px, 0.4);
  EXPECT_LT(rotation_between_deg(alone.camera, with_photo.camera), 1e-9);
}

// Residuals along a straight rim that are a sine of a period that the samples do not divide.
TEST(OutlineNoise, MeasuresSpreadAndHowFarItIsShared) {
  constexpr double period = 41.3;
  // At whole pixels, and so far apart that some distances do not occur.
  for (const double spacing : {1.0, 2.5}) {
    std::vector<RimSample> rim;
    std::vector<RimResidual> residuals;
    for (std::size_t i = 0; i < 600; ++i) {
      RimSample sample;
      sample.at << spacing * static_cast<double>(i), 30;
      sample.outward << 0, 1;
      rim.push_back(sample);
      RimResidual residual;
      residual.sample = i;
      residual.direction << 0, 1;
      residual.distance_px = 2 * std::sin(sample.at.x() * 2 * std::numbers::pi / period);
      residual.weight = 1;
      residuals.push_back(residual);
    }
    const OutlineNoise noise = outline_noise(rim, residuals);
    EXPECT_NEAR(noise.sigma_px, 1.4826 * std::numbers::sqrt2, 0.05);  // of the median of a sine
    // A cosine's integral up to its first zero, on both sides: 2 * period / (2 pi).
    EXPECT_NEAR(noise.correlation_px, period / std::numbers::pi, 2) << spacing;
  }
}

TEST(OutlineMisfit, TellsOneGapFromMisfitsAllAlong) {
  std::vector<OutlinePiece> together;
  std::vector<OutlinePiece> scattered;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d at(10.0 * i, 0);
    together.push_back({at, 1, i < 40 || i >= 60});
    scattered.push_back({at, 1, i % 5 != 0});
  }
  const OutlineMisfit one = outline_misfit(together, 10);
  EXPECT_NEAR(one.fits, 0.8, 1e-12);
  EXPECT_NEAR(one.largest_gap, 0.2, 1e-12);
  EXPECT_NEAR(one.fits_elsewhere(), 1, 1e-12);
  const OutlineMisfit many = outline_misfit(scattered, 10);
  EXPECT_NEAR(many.largest_gap, 0.01, 1e-12);
  EXPECT_LT(many.fits_elsewhere(), 0.82);
}

TEST(SurfaceDrawing, ShowsTheFaceThatIsNearest) {
  TriangleMesh mesh;  // two squares that face each other, one before the other
  for (const double z : {-0.5, 0.5})
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, -1), Eigen::Vector2d(1, 1), Eigen::Vector2d(-1, 1)})
      mesh.vertices.emplace_back(corner.x() * (z < 0 ? 0.5 : 1), corner.y() * (z < 0 ? 0.5 : 1), z);
  mesh.faces = {{0, 2, 1}, {0, 3, 2}, {4, 6, 5}, {4, 7, 6}};
  const std::vector<Eigen::Vector3f> colors = {{.1F, .1F, .1F}, {.1F, .1F, .1F}, {.1F, .1F, .1F},
                                               {.1F, .1F, .1F}, {.9F, .9F, .9F}, {.9F, .9F, .9F},
                                               {.9F, .9F, .9F}, {.9F, .9F, .9F}};
  const OutlineMesh outline = outline_mesh(mesh, {Eigen::Vector3d::Zero(), 1});
  const LitMesh surface = lit_mesh(outline, colors);
  Window window;
  window.origin.setConstant(-32);
  window.width = window.height = 64;
  OutlinePose pose;
  pose.scale = 20;
  SurfaceDrawing drawing;
  drawing.draw(surface, pose, window);
  const auto pixel = [&](int x, int y) { return drawing.pixels()[static_cast<std::size_t>(64 * y + x)]; };
  EXPECT_NEAR(pixel(32, 32).brightness, 0.1, 1e-6);
  EXPECT_NEAR(pixel(16, 32).brightness, 0.9, 1e-6);
  EXPECT_FALSE(pixel(2, 2).seen);
  EXPECT_NEAR(pixel(32, 32).normal.z(), -1, 1e-6);  // towards the camera
}

// The hull of a scan is looked into through a hole: what is seen there may not be seen of the object.
TEST(SurfaceDrawing, DoesNotSeeTheInsideOfAnOpenMesh) {
  TriangleMesh mesh = knobbed_brick();
  mesh.faces.pop_back();
  const OutlineMesh outline = outline_mesh(mesh, unit_sphere(mesh));
  const LitMesh surface = lit_mesh(outline, {});
  EXPECT_TRUE(surface.one_sided);
  Window window;
  window.origin.setConstant(-40);
  window.width = window.height = 80;
  OutlinePose pose;
  pose.scale = 36;
  int inner = 0;
  SurfaceDrawing drawing;
  for (int i = 0; i < 24; ++i) {
    const Eigen::Vector3d axis(std::sin(1.0 + i), std::cos(2.0 * i), std::sin(3.0 * i));
    pose.rotation = Eigen::AngleAxisd(0.5 * i, axis.normalized()).toRotationMatrix();
    drawing.draw(surface, pose, window);
    for (const SurfacePixel& pixel : drawing.pixels()) {
      inner += pixel.covered && !pixel.seen ? 1 : 0;
      EXPECT_TRUE(pixel.covered || !pixel.seen);
    }
  }
  EXPECT_GT(inner, 20);
  mesh.faces.back() = {mesh.faces.back()[0], mesh.faces.back()[2], mesh.faces.back()[1]};
  EXPECT_FALSE(lit_mesh(outline_mesh(mesh, unit_sphere(mesh)), {}).one_sided);
}

// Light explains the rest of the photo's inside: what it leaves must be noise, not shapes.
TEST(PoseVerdict, DoubtsAPoseWhoseInsideLeavesShapes) {
  RefinedPose pose;
  pose.pose.scale = 150;
  pose.pose.perspective = 0.2;
  pose.agreement.rim_inliers = pose.agreement.image_inliers = 0.95;
  pose.information = 1e6 * PoseMatrix::Identity();
  OutlineFigures figures;
  figures.object_px = 300;
  figures.noise_px = 1.5;
  figures.fits = 0.95;
  const auto verdict = [&](double explained, double independent) {
    figures.explained = explained;
    figures.independent = independent;
    return judge_poses({pose}, {}, figures).verdict;
  };
  EXPECT_EQ(verdict(0, 0), Verdict::accept);  // nobody asked
  EXPECT_EQ(verdict(0.95, 300), Verdict::accept);
  EXPECT_EQ(verdict(0.95, 60), Verdict::review);
  EXPECT_EQ(verdict(0.4, 60), Verdict::accept);  // paint: light explains little, and what is left has shapes
}

TEST(SurfaceLight, GradientIsThatOfTheHarmonics) {
  LightTerms coefficients;
  for (int i = 0; i < light_terms; ++i) coefficients[i] = std::sin(1.0 + i);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.3, -0.5, -0.8).normalized();
  const Eigen::Vector3d gradient = light_gradient(normal, coefficients);
  constexpr double step = 1e-5;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(k);
    const double change =
        (light_harmonics(normal + d) - light_harmonics(normal - d)).dot(coefficients) / (2 * step);
    EXPECT_NEAR(gradient[k], change, 1e-8);
  }
}

// A ball: smooth all over, so that pictures of two poses may be subtracted.
TriangleMesh ball() {
  constexpr int rings = 60;
  constexpr int sides = 120;
  TriangleMesh mesh;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < sides; ++j) {
      const double a = std::numbers::pi * i / rings;
      const double b = 2 * std::numbers::pi * j / sides;
      mesh.vertices.emplace_back(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), 0.8 * std::cos(a));
    }
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(i * sides + j % sides); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sides; ++j) {
      if (i > 0) mesh.faces.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < rings) mesh.faces.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  return mesh;
}

TEST(SurfaceLight, ChangesOfBrightnessAreThoseOfThePicture) {
  TriangleMesh mesh = ball();
  for (const Eigen::Vector3d& x : mesh.vertices)
    mesh.colors.push_back(
        Eigen::Vector3f::Constant(static_cast<float>(0.5 + 0.3 * std::sin(4 * x.x() + 3 * x.z()))));
  const OutlineMesh outline = outline_mesh(mesh, {Eigen::Vector3d::Zero(), 1});
  const LitMesh surface = lit_mesh(outline, mesh.colors);
  Window window;
  window.origin.setConstant(-90);
  window.width = window.height = 180;
  OutlinePose pose;
  pose.scale = 80;
  pose.perspective = 0.2;
  pose.shift << 3, -5;
  pose.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  LightTerms light = LightTerms::Zero();
  light.head<9>() << 0.6, 0.2, -0.3, -0.25, 0.05, 0.04, -0.06, 0.03, 0.02;
  const auto shown = [&](const OutlinePose& at, std::size_t p) {
    SurfaceDrawing drawing;
    drawing.draw(surface, at, window);
    const SurfacePixel& pixel = drawing.pixels()[p];
    return static_cast<double>(pixel.brightness) * light_harmonics(pixel.normal.cast<double>()).dot(light);
  };
  SurfaceDrawing drawing;
  drawing.draw(surface, pose, window);
  std::vector<std::size_t> pixels;
  for (const int x : {60, 80, 95, 110})
    for (const int y : {65, 85, 120}) pixels.push_back(static_cast<std::size_t>(180 * y + x));
  const Eigen::MatrixXd changes = brightness_changes(drawing.pixels(), window, pose, pixels, light, 1);
  for (int k = 0; k < 7; ++k) {
    const double step = k < 3 || k == 6 ? 0.01 : 0.8;
    PoseVector move = PoseVector::Zero();
    move[k] = step;
    const double largest = changes.col(k).cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double change =
          (shown(moved(pose, move), pixels[i]) - shown(moved(pose, -move), pixels[i])) / (2 * step);
      EXPECT_NEAR(changes(static_cast<Eigen::Index>(i), k), change, 0.15 * largest) << k << " " << i;
    }
  }
}

}  // namespace
}  // namespace drape::alignment
