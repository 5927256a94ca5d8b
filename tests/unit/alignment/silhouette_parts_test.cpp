// The parts that the outline's method is made of, each against something simpler.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "bit_raster.hpp"
#include "bodies.hpp"
#include "chamfer_search.hpp"
#include "drape/base/random.hpp"
#include "outline_drawing.hpp"
#include "outline_pose.hpp"
#include "photo_plane.hpp"
#include "polar_view.hpp"
#include "stencil_evidence.hpp"
#include "support.hpp"
#include "view_atlas.hpp"

namespace drape::alignment {
namespace {

OutlinePose some_pose() {
  OutlinePose pose;
  pose.rotation = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
  pose.scale = 90;
  pose.shift << 12, -7;
  pose.perspective = 0.3;
  pose.principal << 2, 3;
  return pose;
}

TEST(OutlinePose, DerivativesAreThoseOfFiniteDifferences) {
  const OutlinePose pose = some_pose();
  const Eigen::Vector3d x(0.4, -0.3, 0.6);
  for (const Eigen::Vector2d& direction : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0.6, -0.8)}) {
    const PoseVector analytic = place_derivative(pose, pose.rotation * x, direction);
    for (int i = 0; i < pose_parameters; ++i) {
      const double h = 1e-6;
      PoseVector step = PoseVector::Zero();
      step[i] = h;
      const OutlinePose up = moved(pose, step);
      const OutlinePose down = moved(pose, -step);
      const double numeric =
          direction.dot(up.place(up.rotation * x) - down.place(down.rotation * x)) / (2 * h);
      EXPECT_NEAR(analytic[i], numeric, 1e-5 * std::max(1.0, std::abs(numeric))) << i;
    }
  }
}

TEST(OutlinePose, IsTheCameraItBecomes) {
  const UnitSphere sphere{{100, -20, 7}, 4};
  OutlinePose pose = some_pose();
  for (const Camera::Projection projection :
       {Camera::Projection::perspective, Camera::Projection::orthographic}) {
    if (projection == Camera::Projection::orthographic) pose.perspective = 0;
    const Camera camera = camera_of(pose, sphere, projection, {80, 60}, 160, 120);
    for (const Eigen::Vector3d& x : {Eigen::Vector3d(0.1, 0.5, -0.6), Eigen::Vector3d(-0.7, 0.2, 0.3)}) {
      const Eigen::Vector2d expected = pose.place(pose.rotation * x) + Eigen::Vector2d(80, 60);
      EXPECT_LT((camera.project(sphere.center + sphere.radius * x).pixel - expected).norm(), 1e-9);
    }
    const std::optional<OutlinePose> back = pose_of(camera, sphere, {80, 60});
    ASSERT_TRUE(back.has_value());
    EXPECT_NEAR(back->scale, pose.scale, 1e-9);
    EXPECT_NEAR(back->perspective, pose.perspective, 1e-12);
    EXPECT_LT((back->shift - pose.shift).norm(), 1e-9);
  }
}

BitImage drawn(const std::vector<Eigen::Vector2d>& corners, const std::vector<Face>& faces, int width,
               int height) {
  BitImage image(width, height);
  draw_faces(corners, faces, image);
  return image;
}

TEST(BitRaster, RectangleHoldsTheCentresWithinIt) {
  const BitImage image =
      drawn({{3.5, 2.2}, {90.5, 2.2}, {90.5, 17.6}, {3.5, 17.6}}, {{0, 1, 2}, {0, 2, 3}}, 100, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 100; ++x)
      EXPECT_EQ(image.at(x, y), x + 0.5 >= 3.5 && x + 0.5 < 90.5 && y + 0.5 >= 2.2 && y + 0.5 < 17.6)
          << x << ' ' << y;
}

TEST(BitRaster, IsClippedToTheImage) {
  const BitImage image = drawn({{-1e9, -1e9}, {1e9, -1e9}, {0, 1e9}}, {{0, 1, 2}}, 70, 9);
  for (const std::uint64_t word : {image.row(0)[0], image.row(8)[0]}) EXPECT_EQ(word, ~std::uint64_t{0});
  EXPECT_EQ(image.row(4)[1], image.last_word_mask());
}

TEST(BitRaster, SharedEdgesBelongToExactlyOneFace) {
  // A fan about a random centre tiles a rectangle: every pixel once, by parity.
  Rng rng(5);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Eigen::Vector2d> corners = {{rng.uniform(5, 60), rng.uniform(5, 40)}};
    const int around = 40;
    for (int i = 0; i < around; ++i) {
      const double t = 4.0 * i / around;
      const double s = t - std::floor(t);
      const Eigen::Vector2d square[] = {{0, 0}, {66, 0}, {66, 48}, {0, 48}, {0, 0}};
      const int side = static_cast<int>(t);
      corners.push_back((1 - s) * square[side] + s * square[side + 1]);
    }
    std::vector<int> times(66 * 48, 0);
    for (std::uint32_t i = 0; i < around; ++i) {
      const BitImage one = drawn(corners, {{0, i + 1, (i + 1) % around + 1}}, 66, 48);
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 66; ++x) times[static_cast<std::size_t>(y * 66 + x)] += one.at(x, y) ? 1 : 0;
    }
    for (const int count : times) EXPECT_EQ(count, 1);
  }
}

TEST(BitRaster, AgreesWithOpenGLButForCentresOnEdges) {
  const TriangleMesh mesh = test::torus(1, 0.4);
  const UnitSphere sphere = unit_sphere(mesh);
  const OutlineMesh outline = outline_mesh(mesh, sphere);
  OutlinePose pose = some_pose();
  pose.scale = 40;
  pose.principal.setZero();
  const Camera camera = camera_of(pose, sphere, Camera::Projection::perspective, {80, 60}, 160, 120);
  const Image8 expected = stencil_of(mesh, camera);
  OutlineDrawing drawing;
  drawing.draw(outline, pose, {{-80, -60}, 1, 160, 120});
  int differences = 0;
  int object = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      object += expected.at(x, y) == stencil::object ? 1 : 0;
      differences += drawing.stencil().at(x, y) != (expected.at(x, y) == stencil::object) ? 1 : 0;
    }
  EXPECT_GT(object, 1000);
  EXPECT_LE(differences, 2);  // OpenGL rounds corners to 1/256 of a pixel
}

TEST(OutlineDrawing, WhatItsOutlineWindsAboutIsWhatItsFacesCover) {
  const TriangleMesh torus = test::torus(1, 0.4);
  TriangleMesh open = torus;
  std::erase_if(open.faces, [&](const Face& f) { return torus.vertices[f[0]].z() > 0.2; });
  TriangleMesh inside_out = torus;  // one face, and the rest of a quarter
  for (std::size_t f = 0; f < inside_out.faces.size(); ++f)
    if (f == 7 || torus.vertices[inside_out.faces[f][0]].x() > 0.8)
      std::swap(inside_out.faces[f][0], inside_out.faces[f][1]);
  TriangleMesh finned = torus;  // three faces at an edge
  finned.vertices.emplace_back(0.2, 0.3, 1.2);
  finned.faces.push_back(
      {torus.faces[5][0], torus.faces[5][1], static_cast<std::uint32_t>(finned.vertices.size() - 1)});
  EXPECT_TRUE(outline_mesh(torus, unit_sphere(torus)).closed);
  EXPECT_FALSE(outline_mesh(inside_out, unit_sphere(torus)).closed);
  const Window window{{-80, -60}, 1, 160, 120};
  for (const TriangleMesh& mesh : {torus, open, inside_out, finned})
    for (const double angle : {0.0, 0.7, 2.1}) {
      const OutlineMesh outline = outline_mesh(mesh, unit_sphere(mesh));
      OutlinePose pose = some_pose();
      pose.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d(0.3, 1, 0.2).normalized()) * pose.rotation;
      OutlineDrawing drawing;
      drawing.draw(outline, pose, window);
      std::vector<Eigen::Vector2d> places;
      for (const Eigen::Vector3d& x : outline.vertices)
        places.push_back(window.from_photo(pose.place(pose.rotation * x)));
      const BitImage faces = drawn(places, outline.faces, window.width, window.height);
      for (int y = 0; y < window.height; ++y)
        for (int x = 0; x < window.width; ++x)
          ASSERT_EQ(drawing.stencil().at(x, y), faces.at(x, y)) << x << ' ' << y;
    }
}

TEST(OutlineDrawing, CapsShowWhatIsMissingAtTheOutline) {
  // A cube without its right side, seen from where that side would be seen too.
  TriangleMesh cube = test::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  std::erase_if(cube.faces, [&](const Face& f) {
    return std::all_of(f.begin(), f.end(), [&](std::uint32_t v) { return cube.vertices[v].x() > 0.4; });
  });
  const OutlineMesh open = outline_mesh(cube, unit_sphere(cube));
  EXPECT_EQ(open.caps.size(), 4U);
  EXPECT_EQ(open.border_middles.size(), 1U);
  OutlinePose pose;
  pose.scale = 40;
  pose.rotation = Eigen::AngleAxisd(std::numbers::pi / 4, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const Window window{{-50, -50}, 1, 100, 100};
  OutlineDrawing drawing;
  drawing.draw(open, pose, window);
  // Nothing is missing where the far side is seen through the opening, and no pixel is both.
  int gaps = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      gaps += drawing.gaps().at(x, y) ? 1 : 0;
      EXPECT_FALSE(drawing.gaps().at(x, y) && drawing.stencil().at(x, y));
    }
  EXPECT_EQ(gaps, 0);
  // Without the side behind the opening as well, one sees through, out of the outline.
  std::erase_if(cube.faces, [&](const Face& f) {
    return std::all_of(f.begin(), f.end(), [&](std::uint32_t v) { return cube.vertices[v].z() > 0.4; });
  });
  const OutlineMesh wider = outline_mesh(cube, unit_sphere(cube));
  drawing.draw(wider, pose, window);
  EXPECT_TRUE(drawing.gaps().at(60, 50) || drawing.gaps().at(40, 50));
}

TEST(BitRaster, GapsAreWhatTheBorderDoesNotReach) {
  Rng rng(3);
  BitImage mesh(150, 40);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 150; ++x)
      if (rng.uniform() < 0.45) mesh.set(x, y);
  std::vector<std::uint8_t> outside(150 * 40, 0);
  std::vector<std::pair<int, int>> stack;
  const auto visit = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= 150 || y >= 40 || mesh.at(x, y)) return;
    std::uint8_t& seen = outside[static_cast<std::size_t>(y * 150 + x)];
    if (seen == 0) stack.emplace_back(x, y);
    seen = 1;
  };
  for (int x = 0; x < 150; ++x) visit(x, 0), visit(x, 39);
  for (int y = 0; y < 40; ++y) visit(0, y), visit(149, y);
  while (!stack.empty()) {
    const auto [x, y] = stack.back();
    stack.pop_back();
    visit(x - 1, y), visit(x + 1, y), visit(x, y - 1), visit(x, y + 1);
  }
  const BitImage gaps = enclosed_gaps(mesh);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 150; ++x)
      EXPECT_EQ(gaps.at(x, y), !mesh.at(x, y) && outside[static_cast<std::size_t>(y * 150 + x)] == 0);
}

TEST(PolarView, RollScoresAreThoseOfCountingBits) {
  Rng rng(7);
  PolarStencil stencil;
  PolarBits view{};
  for (std::size_t i = 0; i < polar_rings; ++i) {
    stencil.known[i] = rng.next() | rng.next();
    stencil.object[i] = rng.next() & stencil.known[i];
    view[i] = rng.next();
  }
  std::array<float, polar_angles> scores{};
  score_rolls(stencil, view, scores);
  const auto bit = [](std::uint64_t word, int j) { return ((word >> (j & 63)) & 1U) != 0; };
  for (int roll = 0; roll < polar_angles; ++roll) {
    double both = 0;
    double either = 0;
    for (int ring = 0; ring < polar_rings; ++ring)
      for (int j = 0; j < polar_angles; ++j) {
        const auto i = static_cast<std::size_t>(ring);
        if (!bit(stencil.known[i], j)) continue;
        const bool model = bit(view[i], j - roll + 64);
        const bool photo = bit(stencil.object[i], j);
        both += model && photo ? ring + 0.5 : 0;
        either += model || photo ? ring + 0.5 : 0;
      }
    EXPECT_NEAR(scores[static_cast<std::size_t>(roll)], both / either, 1e-6);
  }
}

TEST(PolarView, ARollTurnsThePictureTheSameWay) {
  // A bar to the right, turned by a quarter from x towards y, points down.
  const auto bar = [](double x, double y) { return x > 0 && std::abs(y) < 0.3; };
  const auto down = [](double x, double y) { return y > 0 && std::abs(x) < 0.3; };
  PolarStencil stencil;
  stencil.object = polar_bits({}, down);
  stencil.known.fill(~std::uint64_t{0});
  std::array<float, polar_angles> scores{};
  score_rolls(stencil, polar_bits({}, bar), scores);
  EXPECT_EQ(std::max_element(scores.begin(), scores.end()) - scores.begin(), 16);
}

TEST(ChamferSearch, PutsAViewWhereTheRestOfItsOutlineIs) {
  const TriangleMesh mesh = knobbed_brick();
  const OutlineMesh outline = outline_mesh(mesh, unit_sphere(mesh));
  const std::vector<AtlasView> views = view_atlas(outline, 60, 0.2);
  // The photo shows one of the views, turned, enlarged and cut through.
  OutlinePose pose;
  const double angle = 0.7;
  pose.rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * views[17].rotation;
  pose.scale = 55;
  pose.shift << 6, -4;
  pose.perspective = 0.2;
  OutlineDrawing drawing;
  drawing.draw(outline, pose, {{-80, -80}, 1, 160, 160});
  Image8 photo(160, 160, 1, stencil::background);
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 110; ++x)
      if (drawing.stencil().at(x, y)) photo.at(x, y) = stencil::object;
  const StencilLevel level = stencil_level(photo, PhotoPlane(160, 160, std::nullopt), 1, 8);
  const std::vector<ChamferMatch> matches = chamfer_matches(outline, views, level, 50);
  ASSERT_EQ(matches.size(), 50U);
  const auto right = std::find_if(matches.begin(), matches.end(), [&](const ChamferMatch& match) {
    return match.view == 17 && std::abs(match.angle - angle) < 0.06 &&
           std::abs(match.scale - pose.scale) < 0.04 * pose.scale &&
           (level.window.to_photo(match.shift) - pose.shift).norm() < 3;
  });
  ASSERT_NE(right, matches.end());
  EXPECT_GT(right->score, 0.6);
  EXPECT_LT(right->score, 1);
}

TEST(PhotoPlane, UndistortsWhatTheLensDistorts) {
  KnownLens lens;
  lens.K << 500, 1, 310, 0, 520, 250, 0, 0, 1;
  lens.distortion = {-0.2, 0.05, 0.001, -0.002, 0.01};
  const PhotoPlane plane(640, 480, lens);
  for (const Eigen::Vector2d& x :
       {Eigen::Vector2d(20, 30), Eigen::Vector2d(400, 300), Eigen::Vector2d(639, 470)})
    EXPECT_LT((plane.to_photo(plane.to_ideal(x)) - x).norm(), 1e-6);
  EXPECT_FALSE(test::error_message(ErrorCode::config, [&] {
                 lens.distortion = {0.1};
                 (void)PhotoPlane(640, 480, lens);
               }).empty());
}

TEST(StencilLevel, ContourOfADiscIsItsCircle) {
  Image8 photo(300, 300, 1, stencil::background);
  const Eigen::Vector2d center(150.3, 149.6);
  const double radius = 90.4;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 300; ++x)
      if ((Eigen::Vector2d(x + 0.5, y + 0.5) - center).norm() < radius) photo.at(x, y) = stencil::object;
  const PhotoPlane plane(300, 300, std::nullopt);
  for (const int step : {1, 2, 3}) {
    const StencilLevel level = stencil_level(photo, plane, step, 5);
    double off = 0;
    for (const ContourPoint& point : level.contour) {
      const Eigen::Vector2d from_center = level.window.to_photo(point.at) + plane.principal_px() - center;
      off += point.length * (from_center.norm() - radius);
      EXPECT_GT(point.outward.dot(from_center.normalized()), 0.98);
    }
    EXPECT_NEAR(level.contour_length * step, 2 * std::numbers::pi * radius,
                0.02 * 2 * std::numbers::pi * radius);
    EXPECT_LT(std::abs(off / level.contour_length), 0.05) << step;  // no bias to either side
  }
}

TEST(StencilLevel, TheImagesBorderAndTheUnknownAreNoOutline) {
  Image8 photo(60, 60, 1, stencil::background);
  for (int y = 20; y < 40; ++y)
    for (int x = 0; x < 30; ++x) photo.at(x, y) = stencil::object;  // cut off by the left border
  for (int y = 0; y < 60; ++y)
    for (int x = 28; x < 34; ++x) photo.at(x, y) = stencil::unknown;
  const StencilLevel level = stencil_level(photo, PhotoPlane(60, 60, std::nullopt), 1, 5);
  ASSERT_FALSE(level.contour.empty());
  for (const ContourPoint& point : level.contour) {
    const Eigen::Vector2d at = level.window.to_photo(point.at) + Eigen::Vector2d(30, 30);
    EXPECT_TRUE(std::abs(at.y() - 20) < 1e-9 || std::abs(at.y() - 40) < 1e-9) << at.transpose();
  }
}

}  // namespace
}  // namespace drape::alignment
