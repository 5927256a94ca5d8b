#include "drape/texturing/texture_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/geometry/ray_caster.hpp"
#include "drape/rendering/renderer.hpp"
#include "painted_object.hpp"
#include "support.hpp"

namespace drape::texturing {
namespace {

using std::numbers::pi;

const auto everywhere = [](const Eigen::Vector3d&) { return true; };

Camera from(const Eigen::Vector3d& eye, int width = 400, int height = 300, double fov_deg = 40) {
  return look_at(eye, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), width, height, fov_deg);
}

Camera orthographic_from(const Eigen::Vector3d& eye, double pixels_per_unit) {
  Camera camera = from(eye);
  camera.projection = Camera::Projection::orthographic;
  camera.K(0, 0) = camera.K(1, 1) = pixels_per_unit;
  return camera;
}

TextureResult textured(const TriangleMesh& mesh, const std::vector<Shot>& shots,
                       const TextureOptions& options = {}) {
  std::vector<TextureView> views;
  for (const Shot& shot : shots) views.push_back(shot.view());
  return texture_mesh(mesh, mesh, views, options);
}

void expect_sound(const TextureResult& result) {
  EXPECT_EQ(problem_of_model(result.model), "");
  EXPECT_NEAR(result.seen_percent + result.filled_percent + result.unseen_percent, 100, 1e-6);
  EXPECT_EQ(result.background_texels_percent, 0);
}

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / pi;
}

// A grid in the plane z = 0 that faces up, from -half to half.
TriangleMesh plate(double half, int steps) {
  TriangleMesh mesh;
  for (int j = 0; j <= steps; ++j)
    for (int i = 0; i <= steps; ++i)
      mesh.vertices.emplace_back(half * (2.0 * i / steps - 1), half * (2.0 * j / steps - 1), 0);
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (steps + 1) + i); };
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

TEST(TextureMesh, ASphereCarriesThePhotoWhereItWasSeen) {
  const TriangleMesh sphere = test::sphere(1, 48);
  const Paint paint = waves(0.8);
  const Eigen::Vector3d eye(4, 1, 1.5);
  const Shot shot = photographed(sphere, from(eye), paint);
  TextureOptions options;
  options.max_incidence_deg = 85;
  const TextureResult result = textured(sphere, {shot}, options);
  expect_sound(result);
  // Bilinear blending within a pixel of about 0.006 units of waves 0.8 long and 90 high, at most 60 degrees
  // oblique: well under 2; rounding 0.5 twice.
  const auto near_front = [&](const Eigen::Vector3d& x) { return degrees_between(x, eye - x) < 60; };
  EXPECT_LT(largest_error(result.model, paint, near_front), 3);
  EXPECT_GT(least_distance_to(result.model, background_color), 150);
  // Painted is what is seen at up to 85 degrees of incidence: a cap up to 85 degrees less the angle at which
  // the camera sees its border. The mesh's facets and the split limit blur its border by about a degree.
  const double distance = eye.norm();
  const double cap = 85 * pi / 180 - std::asin(std::sin(85 * pi / 180) / distance);
  EXPECT_NEAR(painted_area(result.model), 2 * pi * (1 - std::cos(cap)), 2 * pi * std::sin(cap) * 0.015);
  EXPECT_EQ(result.views[0].material, 0);
  EXPECT_EQ(result.model.materials[0].name, "000_color");
  EXPECT_EQ(result.model.materials[1].name, "grown");
  EXPECT_EQ(result.model.materials[2].name, "unseen");
}

TEST(TextureMesh, RenderedFromTheSameCameraItLooksLikeThePhoto) {
  const TriangleMesh sphere = test::sphere(1, 48);
  const Shot shot = photographed(sphere, from({3, -2, 1}), waves(0.8));
  TextureOptions options;
  options.max_incidence_deg = 89;
  const TextureResult result = textured(sphere, {shot}, options);
  rendering::TexturedStyle style;
  style.samples_per_side = 1;
  const Image8 again = rendering::render_textured(result.model, shot.camera, style);
  double squares = 0;
  double count = 0;
  for (int y = 3; y + 3 < again.height(); ++y)
    for (int x = 3; x + 3 < again.width(); ++x) {
      bool inside = true;  // where the eroded stencil and the incidence leave the photo as it is
      for (const auto& [dx, dy] : {std::pair{-3, 0}, {3, 0}, {0, -3}, {0, 3}})
        inside = inside && shot.stencil.at(x + dx, y + dy) == stencil::object;
      if (!inside) continue;
      for (int c = 0; c < 3; ++c) {
        const double d = static_cast<double>(again.at(x, y, c)) - shot.photo.at(x, y, c);
        squares += d * d;
        count += 1;
      }
    }
  ASSERT_GT(count, 10000);
  EXPECT_GT(10 * std::log10(255 * 255 * count / squares), 38);
}

TEST(TextureMesh, BigFacesFollowThePerspective) {
  // Two triangles a side, seen close up: linear texture coordinates would be off by tens of pixels.
  const TriangleMesh box = test::box({-1, -1, -0.5}, {1, 1, 0.5});
  const Paint paint = waves(1.5);
  const Shot shot = photographed(box, from({2.2, 1.8, 1.8}, 800, 600, 75), paint);
  const TextureResult result = textured(box, {shot});
  expect_sound(result);
  EXPECT_LT(result.model.mesh.faces.size(), 20000U);
  EXPECT_TRUE(mesh_topology(result.model.mesh).closed_manifold());
  // 0.2 px of bend and up to a pixel of blending at a scale of about 0.006 units a pixel, grazing ones more.
  const auto away_from_edges = [](const Eigen::Vector3d& x) {
    const Eigen::Vector3d room = (Eigen::Vector3d(1, 1, 0.5) - x.cwiseAbs()).cwiseAbs();
    return (room.array() < 0.05).count() == 1;
  };
  EXPECT_LT(largest_error(result.model, paint, away_from_edges), 6);
  EXPECT_NEAR(painted_area(result.model), 4 + 2 + 2, 0.15);
}

TEST(TextureMesh, WorksForOrthographicCameras) {
  const TriangleMesh sphere = test::sphere(1, 48);
  const Paint paint = waves(0.8);
  const Eigen::Vector3d eye(5, 2, 2);
  const Shot shot = photographed(sphere, orthographic_from(eye, 120), paint);
  TextureOptions options;
  options.max_incidence_deg = 85;
  const TextureResult result = textured(sphere, {shot}, options);
  expect_sound(result);
  EXPECT_LT(largest_error(result.model, paint,
                          [&](const Eigen::Vector3d& x) { return degrees_between(x, eye) < 60; }),
            3);
  EXPECT_NEAR(painted_area(result.model), 2 * pi * (1 - std::cos(85 * pi / 180)), 0.1);
}

TEST(TextureMesh, NothingIsPaintedThroughAnOccluder) {
  // A plate, and above it a smaller one of another colour that hides part of it.
  TriangleMesh mesh = plate(1, 6);
  const std::size_t low_faces = mesh.faces.size();
  const TriangleMesh small = plate(0.3, 1);
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3d& x : small.vertices)
    mesh.vertices.emplace_back(x + Eigen::Vector3d(0.1, 0.05, 0.5));
  for (const Face& f : small.faces) mesh.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
  const Eigen::Vector3d red(250, 20, 20);
  const Paint paint = [&](const Eigen::Vector3d& x) {
    return x.z() > 0.25 ? red : Eigen::Vector3d(40, 120 + 80 * std::sin(6 * x.x()), 150);
  };
  const Eigen::Vector3d eye(0.8, -0.5, 4);
  const Camera camera = look_at(eye, {0, 0, 0}, Eigen::Vector3d::UnitY(), 400, 400, 40);
  const Shot shot = photographed(mesh, camera, paint);
  const TextureResult result = textured(mesh, {shot});
  expect_sound(result);
  // Only the upper plate may carry red.
  TexturedMesh low = result.model;
  for (std::size_t f = 0; f < low.mesh.faces.size(); ++f)
    if (low.mesh.vertices[low.mesh.faces[f][0]].z() > 0.25) low.face_materials[f] = 1;
  ASSERT_EQ(low.materials[1].name, "grown");
  EXPECT_GT(least_distance_to(low, red), 150);
  EXPECT_LT(largest_error(
                low, paint,
                [](const Eigen::Vector3d& x) { return std::max(std::abs(x.x()), std::abs(x.y())) < 0.97; }),
            4);
  // The shadow of the upper plate on the lower one: its square, enlarged by 4 / (4 - 0.5).
  const double shadow = std::pow(0.6 * 4 / 3.5, 2);
  const double guard = 4 * 0.6 * 4 / 3.5 * 0.012;  // a pixel or two all along its border
  double unseen = 0;
  for (std::size_t f = 0; f < result.model.mesh.faces.size(); ++f)
    if (!is_painted(result.model, f)) unseen += scaled_face_normal(result.model.mesh, f).norm() / 2;
  EXPECT_GT(unseen, shadow);
  EXPECT_LT(unseen, shadow + 2 * guard);
  EXPECT_GT(result.model.mesh.faces.size(), low_faces);
}

// Closer above it than the slope of the ground lets a depth picture tell: only rays can.
TEST(TextureMesh, NothingIsPaintedThroughASheetJustAboveTheGround) {
  const auto square = [](double side, double z) {
    TriangleMesh mesh;
    mesh.vertices = {{-side, -side, z}, {side, -side, z}, {side, side, z}, {-side, side, z}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
  };
  TriangleMesh mesh = square(1, 0);
  for (const Eigen::Vector3d& x : square(0.5, 0.014).vertices) mesh.vertices.push_back(x);
  mesh.faces.push_back({4, 5, 6});
  mesh.faces.push_back({4, 6, 7});
  const Camera camera =
      look_at({0, -4, 0.5}, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), 160, 120, 40);
  const Shot shot = photographed(mesh, camera, waves(0.5));
  const TextureResult result = texture_mesh(mesh, mesh, std::vector<TextureView>{shot.view()}, {});
  const RayCaster caster(mesh);
  double ground = 0;
  double through = 0;
  for (std::size_t f = 0; f < result.model.mesh.faces.size(); ++f) {
    if (!is_painted(result.model, f)) continue;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const std::uint32_t v : result.model.mesh.faces[f]) middle += result.model.mesh.vertices[v] / 3;
    if (middle.z() > 0.001) continue;
    const double area = scaled_face_normal(result.model.mesh, f).norm() / 2;
    ground += area;
    const Eigen::Vector3d towards = camera.towards_camera(middle);
    if (caster.blocked(middle + 0.04 * towards, towards)) through += area;
  }
  EXPECT_GT(ground, 2.5);
  EXPECT_LT(through, 0.001);  // of the 0.1 that it hides
}

TEST(TextureMesh, AHoleShowsTheInsideThatNoPhotoPaints) {
  // A sphere with its top cut off, seen from above: its far inside faces away and stays unseen.
  TriangleMesh bowl = test::sphere(1, 32);
  std::vector<std::uint8_t> keep;
  for (const Face& f : bowl.faces) keep.push_back(bowl.vertices[f[0]].z() < 0.5);
  bowl = with_faces(bowl, keep);
  const Eigen::Vector3d eye(0.5, 0, 6);
  const Camera camera = look_at(eye, {0, 0, 0}, Eigen::Vector3d::UnitY(), 300, 300, 25);
  const TextureResult result = textured(bowl, {photographed(bowl, camera, waves(1))});
  expect_sound(result);
  for (std::size_t f = 0; f < result.model.mesh.faces.size(); ++f)
    if (is_painted(result.model, f)) {
      EXPECT_GT(result.model.mesh.vertices[result.model.mesh.faces[f][0]].z(), -0.05);
    }
}

TEST(TextureMesh, TwoPhotosShareTheSphere) {
  const TriangleMesh sphere = test::sphere(1, 40);
  const Paint paint = waves(0.8);
  const std::vector<Shot> shots = {photographed(sphere, from({5, 0, 0.5}), paint),
                                   photographed(sphere, from({-5, 0, 0.5}), paint),
                                   photographed(sphere, from({5, 0, 0.5}, 40, 30), paint)};
  TextureOptions options;
  options.mode = TextureMode::project;
  const TextureResult result = textured(sphere, shots, options);
  expect_sound(result);
  EXPECT_EQ(result.views[0].material, 0);
  EXPECT_EQ(result.views[1].material, 1);
  // The same view at a tenth of the size has only what its coarser guards leave it at the rim.
  EXPECT_LT(result.views[2].painted_percent, 4);
  EXPECT_NEAR(result.views[0].painted_percent + result.views[2].painted_percent,
              result.views[1].painted_percent, 2);
  for (std::size_t f = 0; f < result.model.mesh.faces.size(); ++f) {
    if (!is_painted(result.model, f)) continue;
    const double x = result.model.mesh.vertices[result.model.mesh.faces[f][0]].x();
    if (result.model.face_materials[f] == 0) {
      EXPECT_GT(x, -0.3);
    }
    if (result.model.face_materials[f] == 1) {
      EXPECT_LT(x, 0.3);
    }
  }
  EXPECT_LT(
      largest_error(result.model, paint, [](const Eigen::Vector3d& x) { return std::abs(x.x()) > 0.6; }), 3);
}

TEST(TextureMesh, WhatOnePhotoSeesPartlyTheOtherCompletes) {
  // Big faces, each cut by the border of both photos: together they paint the whole plate.
  const TriangleMesh big = plate(1, 2);
  const Paint paint = waves(1.5);
  std::vector<Shot> shots;
  for (const double x : {-0.5, 0.5})
    shots.push_back(
        photographed(big, look_at({x, 0, 4}, {x, 0, 0}, Eigen::Vector3d::UnitY(), 330, 640, 16.9), paint));
  TextureOptions options;
  options.stencil_erode_px = 0;
  const TextureResult result = textured(big, shots, options);
  expect_sound(result);
  EXPECT_LT(result.unseen_percent, 1);
  EXPECT_LT(largest_error(result.model, paint,
                          [](const Eigen::Vector3d& x) { return x.cwiseAbs().maxCoeff() < 0.98; }),
            3);
}

TEST(TextureMesh, FacesAcrossTheBorderOfThePhotoAreSplitThere) {
  const TriangleMesh big = plate(2, 3);
  const Camera camera = look_at({0.3, 0.2, 4}, {0.3, 0.2, 0}, Eigen::Vector3d::UnitY(), 300, 200, 30);
  const Paint paint = waves(1.5);
  const TextureResult result = textured(big, {photographed(big, camera, paint)});
  expect_sound(result);
  const double width = 2 * 4 * std::tan(15 * pi / 180);
  const double height = width * 200 / 300;
  const double pixel = width / 300;
  EXPECT_NEAR(painted_area(result.model), width * height, 2 * (width + height) * pixel);
  EXPECT_LT(largest_error(result.model, paint, everywhere), 3);
}

TEST(TextureMesh, SplitsLeaveNoCracks) {
  const TriangleMesh torus = test::torus(1, 0.4, 24, 12);
  const Shot shot = photographed(torus, from({3, 1, 1.4}), waves(0.7));
  const TextureResult result = textured(torus, {shot});
  expect_sound(result);
  EXPECT_GT(result.model.mesh.faces.size(), torus.faces.size());
  const MeshTopology topology = mesh_topology(result.model.mesh);
  EXPECT_TRUE(topology.closed_manifold());
  EXPECT_EQ(topology.euler_characteristic, 0);
  EXPECT_NEAR(surface_area(result.model.mesh), surface_area(torus), 1e-9);
  EXPECT_NEAR(signed_volume(result.model.mesh), signed_volume(torus), 1e-9);
}

TEST(TextureMesh, TheStencilIsAGuardAndColoursGrowOverItsBorder) {
  const TriangleMesh board = plate(1, 8);
  const Paint paint = waves(1.5);
  const Camera camera = look_at({0, 0, 4}, {0, 0, 0}, Eigen::Vector3d::UnitY(), 400, 400, 30);
  Shot shot = photographed(board, camera, paint);
  // The right half of the photo shows something else, says the stencil.
  for (int y = 0; y < 400; ++y)
    for (int x = 200; x < 400; ++x) {
      shot.stencil.at(x, y) = y < 200 ? stencil::background : stencil::unknown;
      for (int c = 0; c < 3; ++c) shot.photo.at(x, y, c) = static_cast<std::uint8_t>(background_color[c]);
    }
  TextureOptions options;
  options.stencil_erode_px = 3;
  options.fill_px = 12;
  const TextureResult result = textured(board, {shot}, options);
  expect_sound(result);
  EXPECT_GT(least_distance_to(result.model, background_color), 150);
  double rightmost = -1;
  for (std::size_t f = 0; f < result.model.mesh.faces.size(); ++f)
    if (is_painted(result.model, f))
      for (const std::uint32_t v : result.model.mesh.faces[f])
        rightmost = std::max(rightmost, result.model.mesh.vertices[v].x());
  const double pixel = 2 * 4 * std::tan(15 * pi / 180) / 400;
  EXPECT_NEAR(rightmost, (12 - 3) * pixel, 1.5 * pixel);
  EXPECT_GT(result.filled_percent, 0.4 * 100 * 12 * pixel / 2);
  EXPECT_GT(result.overhang_percent, 0);
  // Farther in, the photo is as it was.
  EXPECT_LT(largest_error(result.model, paint,
                          [&](const Eigen::Vector3d& x) {
                            return x.x() < -5 * pixel && x.x() > -0.95 && std::abs(x.y()) < 0.95;
                          }),
            3);
  // The coverage picture: untouched, orange, dim.
  const Image8& coverage = result.coverage[0];
  EXPECT_EQ(coverage.at(150, 200, 1), shot.photo.at(150, 200, 1));
  EXPECT_GT(coverage.at(203, 200, 0), 200);
  EXPECT_LT(coverage.at(300, 200, 0), 100);
}

TEST(TextureMesh, UnseenSurfaceIsGreyOrInTheScansColours) {
  TriangleMesh sphere = test::sphere(1, 24);
  const Shot shot = photographed(sphere, from({4, 0, 0}), waves(0.8));
  TextureResult result = textured(sphere, {shot});
  EXPECT_FALSE(result.unseen_in_scan_colour);
  // Grey, but for the ribbon beside the painted part.
  std::size_t grey = 0;
  for (const Eigen::Vector3f& c : result.model.mesh.colors)
    if (c.maxCoeff() < 0.9F && c.maxCoeff() - c.minCoeff() < 0.05F) ++grey;
  EXPECT_GT(grey, 0.4 * static_cast<double>(result.model.mesh.colors.size()));

  for (const Eigen::Vector3d& x : sphere.vertices)
    sphere.colors.emplace_back(0.2F, static_cast<float>(x.x() < 0), 0.4F);
  result = textured(sphere, {shot});
  expect_sound(result);
  EXPECT_TRUE(result.unseen_in_scan_colour);
  EXPECT_EQ(result.model.materials.back().flat_color, Eigen::Vector3f::Ones());
  EXPECT_EQ(result.model.mesh.colors.size(), result.model.mesh.vertices.size());

  TextureOptions options;
  options.unseen = Unseen::neutral;
  options.fill_px = 0;
  result = textured(sphere, {shot}, options);
  EXPECT_FALSE(result.unseen_in_scan_colour);
  EXPECT_TRUE(result.model.mesh.colors.empty());
  EXPECT_LT(result.model.materials.back().flat_color.maxCoeff(), 0.9F);

  for (const Eigen::Vector3d& x : sphere.vertices)
    sphere.intensities.push_back(static_cast<float>(0.5 + 0.4 * x.z()));
  options.unseen = Unseen::intensity;
  result = textured(sphere, {shot}, options);
  for (std::size_t v = 0; v < sphere.vertices.size(); ++v)
    EXPECT_EQ(result.model.mesh.colors[v], Eigen::Vector3f::Constant(sphere.intensities[v]));

  // Inpainting knows the painted side's mean and goes on from there.
  options.unseen = Unseen::inpaint;
  Shot flat = shot;
  std::fill(flat.photo.data().begin(), flat.photo.data().end(), std::uint8_t{90});
  result = textured(sphere, {flat}, options);
  for (const Eigen::Vector3f& c : result.model.mesh.colors)
    EXPECT_LT((c - Eigen::Vector3f::Constant(90 / 255.F)).norm(), 0.01F);
}

TEST(TextureMesh, TheSimplifiedMeshIsPaintedThroughTheFullOnesEyes) {
  // A coarse sphere lies up to 1 - cos(11 deg) = 0.02 under the fine one that hides things; what hides it is
  // not its own finer self.
  const TriangleMesh fine = test::sphere(1, 64);
  const TriangleMesh coarse = test::sphere(1, 8);
  const Shot shot = photographed(fine, from({4, 1, 1}), waves(1));
  const TextureResult result = texture_mesh(coarse, fine, std::vector<TextureView>{shot.view()}, {});
  expect_sound(result);
  const TextureResult on_fine = textured(fine, {shot});
  EXPECT_NEAR(result.seen_percent + result.filled_percent, on_fine.seen_percent + on_fine.filled_percent, 3);
}

TEST(TextureMesh, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh torus = test::torus(1, 0.4);
  const std::vector<Shot> shots = {photographed(torus, from({3, 1, 1.4}), waves(0.7)),
                                   photographed(torus, from({-1, 3, 1.4}), waves(0.7))};
  for (const TextureMode mode : {TextureMode::project, TextureMode::atlas}) {
    TextureOptions options;
    options.mode = mode;
    set_thread_count(1);
    const TextureResult one = textured(torus, shots, options);
    set_thread_count(4);
    const TextureResult four = textured(torus, shots, options);
    set_thread_count(0);
    EXPECT_EQ(one.model.mesh.faces, four.model.mesh.faces);
    EXPECT_EQ(one.model.mesh.vertices, four.model.mesh.vertices);
    EXPECT_EQ(one.model.corner_uvs, four.model.corner_uvs);
    EXPECT_EQ(one.model.face_materials, four.model.face_materials);
    ASSERT_EQ(one.model.materials.size(), four.model.materials.size());
    for (std::size_t i = 0; i < one.model.materials.size(); ++i)
      EXPECT_EQ(one.model.materials[i].image, four.model.materials[i].image);
    EXPECT_EQ(one.coverage, four.coverage);
    EXPECT_EQ(one.atlas_coverage, four.atlas_coverage);
  }
}

TEST(TextureMesh, MovesWithTheWorld) {
  TriangleMesh sphere = test::sphere(1, 24);
  const Shot shot = photographed(sphere, from({4, 1, 1}), waves(1));
  const TextureResult here = textured(sphere, {shot});
  Rigid3 there = Rigid3::Identity();
  there.rotate(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()))
      .pretranslate(Eigen::Vector3d(50, -20, 7));
  Shot moved = shot;
  moved.camera.camera_from_world = shot.camera.camera_from_world * there.inverse();
  for (Eigen::Vector3d& x : sphere.vertices) x = there * x;
  const TextureResult far = textured(sphere, {moved});
  EXPECT_NEAR(here.seen_percent, far.seen_percent, 0.1);
  EXPECT_NEAR(here.filled_percent, far.filled_percent, 0.1);
}

}  // namespace
}  // namespace drape::texturing
