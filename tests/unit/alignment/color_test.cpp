// Alignment by the photo's colours: parts, and from mesh and photo to camera.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "bodies.hpp"
#include "color_model.hpp"
#include "color_occlusion.hpp"
#include "color_rolls.hpp"
#include "drape/alignment/align.hpp"
#include "drape/base/random.hpp"
#include "object_box.hpp"
#include "support.hpp"

namespace drape::alignment {
namespace {

// The body in orange before green and blue, with noise and some of the body's colour elsewhere.
Image8 photo_of(const Image8& silhouette) {
  Image8 rgb(silhouette.width(), silhouette.height(), 3);
  Rng rng(5);
  for (int y = 0; y < rgb.height(); ++y)
    for (int x = 0; x < rgb.width(); ++x) {
      std::array<int, 3> color =
          (x / 37 + y / 29) % 2 == 0 ? std::array{60, 120, 70} : std::array{70, 90, 160};
      if (silhouette.at(x, y) == stencil::object || x < 25) color = {220, 130, 40};
      for (int c = 0; c < 3; ++c)
        rgb.at(x, y, c) =
            static_cast<std::uint8_t>(color[static_cast<std::size_t>(c)] + rng.uniform(-12, 12));
    }
  return rgb;
}

struct Scene {
  TriangleMesh mesh = knobbed_brick();
  Camera truth = view_of({20, 70, 130}).resized(480, 360);
  Image8 silhouette = stencil_of(mesh, truth);
  Image8 rgb = photo_of(silhouette);
  Image8 nothing = Image8(480, 360, 1, stencil::unknown);

  [[nodiscard]] PhotoEvidence evidence() const {
    PhotoEvidence evidence{nothing, std::nullopt, &rgb};
    evidence.stencil_confidence = 0;
    return evidence;
  }
  // The silhouette's box, grown unevenly.
  [[nodiscard]] std::array<double, 4> box() const {
    double left = 480, top = 360, right = 0, bottom = 0;
    for (int y = 0; y < 360; ++y)
      for (int x = 0; x < 480; ++x)
        if (silhouette.at(x, y) == stencil::object) {
          left = std::min<double>(left, x);
          right = std::max<double>(right, x + 1);
          top = std::min<double>(top, y);
          bottom = std::max<double>(bottom, y + 1);
        }
    const double width = right - left;
    const double height = bottom - top;
    return {left - 0.3 * width, top - 0.1 * height, 1.4 * width, 1.3 * height};
  }
};

AlignOptions by(EvidenceKind kind) {
  AlignOptions options;
  options.evidence = kind;
  return options;
}

TEST(UncertaintyCoefficient, IsOneForAPerfectPartAndZeroForNone) {
  const std::array<double, 3> all = {30, 50, 20};
  EXPECT_NEAR(uncertainty_coefficient(std::array<double, 3>{30, 0, 0}, all), 1, 1e-12);
  EXPECT_NEAR(uncertainty_coefficient(std::array<double, 3>{15, 25, 10}, all), 0, 1e-12);
  EXPECT_EQ(uncertainty_coefficient(std::array<double, 3>{0, 0, 0}, all), 0);
  EXPECT_EQ(uncertainty_coefficient(all, all), 0);
  // By hand: one bit of doubt, half of it left for half of the pixels.
  EXPECT_NEAR(uncertainty_coefficient(std::array<double, 2>{50, 0}, std::array<double, 2>{50, 50}), 1, 1e-12);
  const double left_open = 0.75 * (-(1 / 3.0) * std::log2(1 / 3.0) - (2 / 3.0) * std::log2(2 / 3.0));
  EXPECT_NEAR(uncertainty_coefficient(std::array<double, 2>{25, 25}, std::array<double, 2>{25, 75}),
              1 - left_open, 1e-12);
}

// A disc of one colour: rings about its middle score best at its own size, whatever the roll.
TEST(ColorRolls, PreferTheRightSize) {
  ColorLevel level;
  level.window.width = level.window.height = 128;
  level.labels.assign(2, BitImage(128, 128));
  level.label_at = Image8(128, 128, 1);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      level.label_at.at(x, y) = std::hypot(x + 0.5 - 60, y + 0.5 - 70) < 30 ? 0 : 1;
      level.labels[level.label_at.at(x, y)].set(x, y);
    }
  PolarBits disc{};  // of radius sqrt(2) in radii of gyration
  for (std::size_t i = 0; i < polar_rings; ++i)
    if ((static_cast<double>(i) + 0.5) * polar_reach / polar_rings < std::sqrt(2.0))
      disc[i] = ~std::uint64_t{0};
  ColorRegion region;
  const auto best = [&](const Eigen::Vector2d& center, double radius) {
    std::array<float, polar_angles> scores{};
    ColorRolls(level, {center, radius}, region).score(disc, scores);
    return *std::max_element(scores.begin(), scores.end());
  };
  const float right = best({60, 70}, 30 / std::sqrt(2.0));
  EXPECT_GT(right, 0.9F);
  EXPECT_LT(best({60, 70}, 15 / std::sqrt(2.0)), 0.6F);
  EXPECT_LT(best({60, 70}, 45 / std::sqrt(2.0)), 0.6F);
  EXPECT_LT(best({75, 70}, 30 / std::sqrt(2.0)), 0.6F);
  region.click = Eigen::Vector2d(60, 105);  // outside the disc
  EXPECT_EQ(best({60, 70}, 30 / std::sqrt(2.0)), 0.F);
  region.click = Eigen::Vector2d(60, 95);
  EXPECT_EQ(best({60, 70}, 30 / std::sqrt(2.0)), right);
}

TEST(RimStep, FindsWhereTheColoursChange) {
  const int edge = 40;
  Image8 rgb(96, 96, 3);
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x)
      for (int c = 0; c < 3; ++c)
        rgb.at(x, y, c) = static_cast<std::uint8_t>(x < edge ? 200 - 40 * c : 40 + 30 * c);
  const LabWindow window = lab_window(rgb, PhotoPlane(96, 96, {}), {0, 0, 96, 96}, 1);
  const ColorLevel level = color_level(window, color_clusters(window, 8));
  BitImage drawn(96, 96);  // says that the edge is at 37
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 37; ++x) drawn.set(x, y);
  const ColorModel model(level, drawn, region_about(drawn, 0.35), false);
  EXPECT_GT(model.log_ratio(20, 50, 0), 1);
  EXPECT_LT(model.log_ratio(60, 50, 0), -1);
  RimSample sample;
  sample.at = {37, 50.5};
  sample.outward = {1, 0};
  const RimStep step = rim_step(level, model, sample, 12);
  EXPECT_NEAR(step.distance_px, 3, 0.6);
  EXPECT_LT(step.variance_px2, 3);
  EXPECT_GT(edge_step(level, sample, 4), 12);
  EXPECT_LT(edge_step(level, sample, 1), 1);
}

// A bar of another colour across a disc hides it; a spot in its middle is its own.
TEST(HiddenPixels, ArePartsOfOtherThings) {
  Image8 rgb(128, 128, 3);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const bool inside = std::hypot(x - 63.5, y - 63.5) < 40;
      const bool bar = x > 85 && y > 50 && y < 70;
      const bool spot = std::hypot(x - 60, y - 90) < 6;
      const std::array<int, 3> color =
          bar || spot || !inside ? std::array{30, 60, 200} : std::array{220, 180, 40};
      for (int c = 0; c < 3; ++c)
        rgb.at(x, y, c) = static_cast<std::uint8_t>(color[static_cast<std::size_t>(c)]);
    }
  const LabWindow window = lab_window(rgb, PhotoPlane(128, 128, {}), {0, 0, 128, 128}, 1);
  const ColorLevel level = color_level(window, color_clusters(window, 8));
  // A disc as it would be drawn: a polygon of many corners.
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0, 0, 0);
  for (std::uint32_t i = 0; i < 64; ++i) {
    const double turn = 2 * 3.14159265358979 * i / 64;
    mesh.vertices.emplace_back(std::cos(turn), std::sin(turn), 0);
    mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % 64});
  }
  const UnitSphere sphere = unit_sphere(mesh);
  OutlinePose pose;
  pose.scale = 40;
  OutlineDrawing drawing;
  drawing.draw(outline_mesh(mesh, sphere), pose, level.window, false);
  const Image8 hidden = hidden_pixels(level, drawing);
  EXPECT_EQ(hidden.at(95, 60), 1);
  EXPECT_EQ(hidden.at(60, 90), 0);
  EXPECT_EQ(hidden.at(40, 60), 0);
  EXPECT_EQ(hidden.at(10, 10), 0);
}

TEST(Colours, FindThePoseInABox) {
  const Scene scene;
  PhotoEvidence evidence = scene.evidence();
  evidence.box_px = scene.box();
  const Alignment found = align_photo(scene.mesh, evidence, by(EvidenceKind::colour), 1, {});
  EXPECT_LT(rotation_between_deg(found.camera, scene.truth), 1.5);
  EXPECT_EQ(found.evidence, EvidenceKind::colour);
  EXPECT_GT(found.edge_support.value(), 0.9);
  ASSERT_FALSE(found.stencil.empty());
  int differ = 0;
  for (std::size_t i = 0; i < found.stencil.data().size(); ++i)
    differ += found.stencil.data()[i] != scene.silhouette.data()[i] ? 1 : 0;
  EXPECT_LT(differ, 600);  // of 480 x 360
}

TEST(Colours, FindThePoseRoundAClick) {
  const Scene scene;
  PhotoEvidence evidence = scene.evidence();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0;
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 480; ++x)
      if (scene.silhouette.at(x, y) == stencil::object) {
        sum += Eigen::Vector2d(x + 0.5, y + 0.5);
        ++count;
      }
  evidence.click_px = {sum.x() / count, sum.y() / count};
  ASSERT_EQ(scene.silhouette.at(static_cast<int>(sum.x() / count), static_cast<int>(sum.y() / count)),
            stencil::object);
  const Alignment found = align_photo(scene.mesh, evidence, by(EvidenceKind::colour), 1, {});
  EXPECT_LT(rotation_between_deg(found.camera, scene.truth), 1.5);
}

// A stencil of no use as a shape, as one with the plinth or the shadow, still tells where the object is.
TEST(Colours, AreSoughtWhereAWrongStencilSays) {
  const Scene scene;
  const auto [x, y, w, h] = scene.box();
  Image8 block(480, 360, 1, stencil::background);
  for (int v = 0; v < 360; ++v)
    for (int u = 0; u < 480; ++u)
      if (u > x + 0.1 * w && u < x + 0.9 * w && v > y + 0.1 * h && v < y + 0.9 * h)
        block.at(u, v) = stencil::object;
  PhotoEvidence evidence{block, std::nullopt, &scene.rgb};
  evidence.stencil_confidence = 0.3;
  const Alignment found = align_photo(scene.mesh, evidence, {}, 1, {});
  EXPECT_LT(rotation_between_deg(found.camera, scene.truth), 1.5);
  EXPECT_EQ(found.evidence, EvidenceKind::colour);
}

TEST(ObjectBox, IsRoundTheLargestPartWithSomeRoom) {
  Image8 shape(200, 100, 1, stencil::background);
  EXPECT_FALSE(object_box(shape).has_value());
  for (int y = 20; y < 60; ++y)
    for (int x = 100; x < 195; ++x) shape.at(x, y) = stencil::object;
  for (int y = 10; y < 14; ++y)
    for (int x = 5; x < 9; ++x) shape.at(x, y) = stencil::object;
  EXPECT_EQ(object_box(shape), (std::array{90.5, 16.0, 109.5, 48.0}));  // cut off where the photo ends
}

// Segments that part the body and the ground at random, but never run across the outline.
TEST(Colours, SegmentsAreUnited) {
  const Scene scene;
  Image<std::int32_t> segments(480, 360, 1, 0);
  for (int y = 0; y < 360; ++y)
    for (int x = 0; x < 480; ++x)
      segments.at(x, y) = (scene.silhouette.at(x, y) == stencil::object ? 20 : 0) + x / 110 + 5 * (y / 120);
  PhotoEvidence evidence = scene.evidence();
  evidence.box_px = scene.box();
  evidence.segments = &segments;
  const Alignment found = align_photo(scene.mesh, evidence, by(EvidenceKind::segments), 1, {});
  EXPECT_LT(rotation_between_deg(found.camera, scene.truth), 1.5);
  EXPECT_EQ(found.evidence, EvidenceKind::segments);
}

TEST(Colours, AreAskedWhereTheStencilProvesNothing) {
  const Scene scene;
  PhotoEvidence evidence = scene.evidence();
  evidence.box_px = scene.box();
  EXPECT_EQ(align_photo(scene.mesh, evidence, {}, 1, {}).evidence, EvidenceKind::colour);
  PhotoEvidence masked{scene.silhouette, std::nullopt, &scene.rgb};
  EXPECT_EQ(align_photo(scene.mesh, masked, {}, 1, {}).evidence, EvidenceKind::stencil);
}

TEST(Colours, RejectAPhotoOfOneColour) {
  const Scene scene;
  const Image8 grey(480, 360, 3, 127);
  PhotoEvidence evidence{scene.nothing, std::nullopt, &grey};
  const Alignment found = align_photo(scene.mesh, evidence, by(EvidenceKind::colour), 1, {});
  EXPECT_EQ(found.verdict, Verdict::reject);
  const Image8 speck(1, 1, 3, 127);
  const Image8 one(1, 1, 1, stencil::unknown);
  EXPECT_EQ(align_photo(scene.mesh, {one, std::nullopt, &speck}, by(EvidenceKind::colour), 1, {}).verdict,
            Verdict::reject);
}

TEST(Colours, RefuseHintsOutsideThePhoto) {
  const Scene scene;
  const auto message = [&](const PhotoEvidence& evidence) {
    return test::error_message(
        ErrorCode::config, [&] { (void)align_photo(scene.mesh, evidence, by(EvidenceKind::colour), 1, {}); });
  };
  PhotoEvidence evidence = scene.evidence();
  evidence.box_px = {500, 20, 30, 30};
  EXPECT_NE(message(evidence).find("holds no pixel"), std::string::npos);
  evidence.box_px.reset();
  evidence.click_px = {-3, 20};
  EXPECT_NE(message(evidence).find("lies outside"), std::string::npos);
  EXPECT_NE(message({scene.nothing}).find("needs the photo"), std::string::npos);
}

}  // namespace
}  // namespace drape::alignment
