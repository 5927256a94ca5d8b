#include "drape/rendering/renderer.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"
#include "lattice_sheet.hpp"
#include "support.hpp"
#include "test_cameras.hpp"

namespace drape::rendering {
namespace {

using Projection = Camera::Projection;
constexpr Projection both_projections[] = {Projection::perspective, Projection::orthographic};
// Rasterisers snap corners to 1/256 of a pixel.
constexpr double snap_px = 0.006;

Eigen::Vector2d center_of(int x, int y) {
  return {x + 0.5, y + 0.5};
}

std::vector<Eigen::Vector2d> pixels_of(const std::vector<Eigen::Vector3d>& points, const Camera& camera) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3d& x : points) pixels.push_back(camera.project(x).pixel);
  return pixels;
}

// Every pixel centre that is clearly inside or outside of the hull of the points; returns how many were
// close.
int expect_hull(const Image8& picture, const std::vector<Eigen::Vector2d>& hull) {
  int close = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const double distance = distance_to_hull(hull, center_of(x, y));
      if (std::abs(distance) < 0.05) ++close;
      if (std::abs(distance) < snap_px) continue;
      EXPECT_EQ(picture.at(x, y), distance < 0 ? stencil::object : stencil::background)
          << x << ", " << y << " is " << distance << " px outside";
    }
  return close;
}

TEST(Stencil, OfABoxIsTheHullOfItsProjectedCorners) {
  const TriangleMesh mesh = test::box({-0.6, -0.45, -0.5}, {0.55, 0.6, 0.4});
  Renderer renderer(mesh);
  int close = 0;
  for (const Projection projection : both_projections)
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const Camera camera = random_camera(seed, projection);
      close += expect_hull(renderer.stencil(camera), pixels_of(mesh.vertices, camera));
    }
  EXPECT_GT(close, 100);  // or the test says nothing of hundredths of a pixel
}

TEST(Stencil, OfTinyTrianglesIsWhereTheCameraProjectsThem) {
  Rng rng(5);
  TriangleMesh mesh;
  for (int i = 0; i < 40; ++i) {
    // One to a cell of a lattice, so that no two overlap.
    const Eigen::Vector3d corner(-0.75 + 0.2 * (i % 8), -0.55 + 0.2 * (i / 8), rng.uniform(-0.01, 0.01));
    for (int k = 0; k < 3; ++k)
      mesh.vertices.emplace_back(corner +
                                 0.05 * Eigen::Vector3d(rng.uniform(), rng.uniform(), rng.uniform()));
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.faces.push_back({first, first + 1, first + 2});
  }
  Renderer renderer(mesh);
  for (const Projection projection : both_projections) {
    Camera camera = random_camera(3, projection);
    camera.camera_from_world =
        look_at({0.4, 0.3, -5}, {0, 0, 0}, {0, 1, 0.2}, 310, 230, 30).camera_from_world;
    const DepthMap map = renderer.depth_map(camera);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const std::vector<Eigen::Vector2d> corners =
          pixels_of({mesh.vertices[3 * f], mesh.vertices[3 * f + 1], mesh.vertices[3 * f + 2]}, camera);
      for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
          if ((center_of(x, y) - corners[0]).norm() > 30) continue;
          const double distance = distance_to_hull(corners, center_of(x, y));
          if (std::abs(distance) < snap_px) continue;
          EXPECT_EQ(map.faces.at(x, y) == static_cast<std::int32_t>(f), distance < 0);
        }
    }
  }
}

TEST(Stencil, OfASphereIsItsOutline) {
  const Eigen::Vector3d center(0.1, -0.2, 0.15);
  Renderer renderer(test::sphere(0.8, 160, center));
  for (const Projection projection : both_projections) {
    const Camera camera = random_camera(8, projection, 3);
    const Image8 picture = renderer.stencil(camera);
    for (int y = 0; y < picture.height(); ++y)
      for (int x = 0; x < picture.width(); ++x) {
        const Eigen::Vector3d a = camera.unproject(center_of(x, y), 1);
        const Eigen::Vector3d along = (camera.unproject(center_of(x, y), 2) - a).normalized();
        const double miss = (center - a).cross(along).norm();
        // The mesh lies within the sphere by 0.8 (1 - cos(pi / 320)) at most.
        if (miss < 0.7998) {
          EXPECT_EQ(picture.at(x, y), stencil::object);
        } else if (miss > 0.8001) {
          EXPECT_EQ(picture.at(x, y), stencil::background);
        }
      }
  }
}

TEST(DepthMap, OfASphereIsItsNearSide) {
  const Eigen::Vector3d center(0.1, -0.2, 0.15);
  Renderer renderer(test::sphere(0.8, 160, center));
  for (const Projection projection : both_projections) {
    const Camera camera = random_camera(9, projection, 3);
    const DepthMap map = renderer.depth_map(camera);
    int seen = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3d a = camera.unproject(center_of(x, y), 1);
        const Eigen::Vector3d per_depth = camera.unproject(center_of(x, y), 2) - a;
        const Eigen::Vector3d along = per_depth.normalized();
        const double miss = (center - a).cross(along).norm();
        if (miss > 0.75) continue;
        const double ahead = along.dot(center - a) - std::sqrt(0.64 - miss * miss);
        EXPECT_NEAR(map.depth.at(x, y), 1 + ahead / per_depth.norm(), 4e-4);
        ++seen;
      }
    EXPECT_GT(seen, 5000);
  }
}

TEST(DepthMap, OfAPlaneIsExactAlsoFromVeryNearAndVeryFar) {
  TriangleMesh plane;
  plane.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  plane.faces = {{0, 1, 2}, {0, 2, 3}};
  Renderer renderer(plane);
  for (const double distance : {0.02, 1.0, 3000.0}) {
    Camera camera =
        look_at(distance * Eigen::Vector3d(0.5, 0.3, 1).normalized(), {0, 0, 0}, {0, 1, 0}, 64, 48, 1);
    camera.K(0, 0) = camera.K(1, 1) = 40 * std::max(distance, 1.0);
    const DepthMap map = renderer.depth_map(camera);
    ASSERT_GE(map.faces.at(32, 24), 0);
    int seen = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        if (map.faces.at(x, y) < 0) {
          EXPECT_TRUE(std::isinf(map.depth.at(x, y)));
          continue;
        }
        ++seen;
        const Eigen::Vector3d hit = camera.unproject(center_of(x, y), map.depth.at(x, y));
        EXPECT_NEAR(hit.z(), 0, 3e-7 * std::max(distance, 1.0));
      }
    EXPECT_GT(seen, 500);
  }
}

// The nearest face at every pixel centre, by brute force; `sure` is false where a hundredth of a pixel or a
// rounding error of the depth decides.
struct Twin {
  Image<std::int32_t> faces;
  Image8 sure;
};

Twin twin_of(const TriangleMesh& mesh, const Camera& camera) {
  Twin twin{Image<std::int32_t>(camera.width, camera.height, 1, DepthMap::no_face),
            Image8(camera.width, camera.height, 1, 1)};
  ImageF nearest(camera.width, camera.height, 1, std::numeric_limits<float>::infinity());
  ImageF second = nearest;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Eigen::Matrix3d corners;  // homogeneous pixels, so that barycentric weights are perspectively right
    for (int k = 0; k < 3; ++k) {
      const Camera::Projected p = camera.project(mesh.vertices[mesh.faces[f][static_cast<std::size_t>(k)]]);
      const double w = camera.projection == Projection::perspective ? p.depth : 1;
      corners.col(k) << p.pixel * w, w;
    }
    const Eigen::Matrix3d weights_from_pixel = corners.inverse();
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const Eigen::Vector3d pixel(x + 0.5, y + 0.5, 1);
        const Eigen::Vector3d weights = weights_from_pixel * pixel;
        double to_edge = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k)
          to_edge = std::min(to_edge, weights[k] / weights_from_pixel.row(k).head<2>().norm());
        if (std::abs(to_edge) < 0.02) twin.sure.at(x, y) = 0;
        if (to_edge < 0) continue;
        const Eigen::Vector3d hit = mesh.vertices[mesh.faces[f][0]] * (weights[0] / weights.sum()) +
                                    mesh.vertices[mesh.faces[f][1]] * (weights[1] / weights.sum()) +
                                    mesh.vertices[mesh.faces[f][2]] * (weights[2] / weights.sum());
        const auto depth = static_cast<float>(camera.project(hit).depth);
        if (depth < nearest.at(x, y)) {
          second.at(x, y) = nearest.at(x, y);
          nearest.at(x, y) = depth;
          twin.faces.at(x, y) = static_cast<std::int32_t>(f);
        } else {
          second.at(x, y) = std::min(second.at(x, y), depth);
        }
      }
  }
  for (std::size_t i = 0; i < nearest.data().size(); ++i)
    if (second.data()[i] - nearest.data()[i] < 1e-5F) twin.sure.data()[i] = 0;
  return twin;
}

TEST(DepthMap, FacesAgreeWithABruteForceTwin) {
  TriangleMesh mesh = test::torus(0.7, 0.3, 14, 9);
  std::swap(mesh.faces[3][0], mesh.faces[3][1]);  // which way round a face is does not matter
  Renderer renderer(mesh);
  for (const Projection projection : both_projections)
    for (std::uint64_t seed = 20; seed < 22; ++seed) {
      const Camera camera = random_camera(seed, projection, 4, 120, 90);
      const DepthMap map = renderer.depth_map(camera);
      const Image8 covered = renderer.stencil(camera);
      const Twin twin = twin_of(mesh, camera);
      int compared = 0;
      for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
          EXPECT_EQ(covered.at(x, y) == stencil::object, map.faces.at(x, y) >= 0);
          if (twin.sure.at(x, y) == 0) continue;
          EXPECT_EQ(map.faces.at(x, y), twin.faces.at(x, y)) << x << ", " << y;
          ++compared;
        }
      EXPECT_GT(compared, camera.width * camera.height * 8 / 10);
    }
}

TEST(DepthMap, NumbersHundredThousandsOfFaces) {
  // A sheet with one square cell per pixel, the diagonal clear of the pixels' centres.
  constexpr int width = 500;
  constexpr int height = 300;
  const TriangleMesh sheet =
      test::lattice_sheet(width, height, [](int x, int y) { return Eigen::Vector3d(x - 0.1, y + 0.1, 7); });
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.width = width;
  camera.height = height;
  const DepthMap map = Renderer(sheet).depth_map(camera);
  // The centre (0.5, 0.5) lies at (0.6, 0.4) of its cell: on the diagonal; a shift decides for one side.
  camera.K(0, 2) = 0.2;
  const DepthMap shifted = Renderer(sheet).depth_map(camera);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      EXPECT_EQ(map.faces.at(x, y) / 2, y * width + x);
      EXPECT_EQ(shifted.faces.at(x, y), 2 * (y * width + x));
    }
}

TEST(Renderer, DrawsNothingOfAnEmptyMesh) {
  Renderer renderer{TriangleMesh{}};
  const Camera camera = random_camera(1, Projection::perspective, 5, 20, 10);
  EXPECT_EQ(renderer.stencil(camera), Image8(20, 10, 1, stencil::background));
  EXPECT_EQ(renderer.depth_map(camera).faces, Image<std::int32_t>(20, 10, 1, -1));
  EXPECT_EQ(renderer.shaded(camera), Image8(20, 10, 3, 255));
}

TEST(Renderer, DrawsNothingOfWhatIsBehindTheCamera) {
  Renderer renderer(test::sphere(1));
  const Camera camera = look_at({0, 0, 5}, {0, 0, 10}, {0, 1, 0}, 40, 30, 60);
  EXPECT_EQ(renderer.stencil(camera), Image8(40, 30, 1, stencil::background));
  EXPECT_EQ(renderer.depth_map(camera).faces, Image<std::int32_t>(40, 30, 1, -1));
}

TEST(Renderer, SeesTheFarWallFromWithinABox) {
  Renderer renderer(test::box({-1, -1, -1}, {1, 1, 1}));
  const Camera camera = look_at({0.2, 0.1, 0}, {0.2, 0.1, 1}, {0, 1, 0}, 40, 30, 50);
  EXPECT_EQ(renderer.stencil(camera), Image8(40, 30, 1, stencil::object));
  const DepthMap map = renderer.depth_map(camera);
  for (const float depth : map.depth.data()) EXPECT_NEAR(depth, 1, 1e-6);
}

TEST(Renderer, CutsAFaceThatReachesBehindTheCamera) {
  TriangleMesh floor;
  floor.vertices = {{-100, 0, -50}, {100, 0, -50}, {100, 0, 50}, {-100, 0, 50}};
  floor.faces = {{0, 1, 2}, {0, 2, 3}};
  const Camera camera = look_at({0, 1, 0}, {0, 1, 1}, {0, 1, 0}, 41, 41, 60);
  const DepthMap map = Renderer(floor).depth_map(camera);
  const double focal = camera.K(0, 0);
  for (int y = 0; y < 41; ++y) {
    const double below = y + 0.5 - 20.5;
    const double depth = focal / below;
    if (std::abs(below) < 1e-9 || std::abs(depth - 50) < 1) continue;
    if (below > 0 && depth < 50)
      EXPECT_NEAR(map.depth.at(20, y), depth, 1e-4 * depth);
    else
      EXPECT_EQ(map.faces.at(20, y), -1);
  }
}

TEST(Renderer, DrawsASinglePixel) {
  Renderer renderer(test::sphere(1));
  const Camera camera = look_at({0, 0, -5}, {0, 0, 0}, {0, 1, 0}, 1, 1, 10);
  EXPECT_EQ(renderer.stencil(camera).at(0, 0), stencil::object);
  EXPECT_NEAR(renderer.depth_map(camera).depth.at(0, 0), 4, 1e-3);
  EXPECT_LT(renderer.shaded(camera).at(0, 0), 255);
}

TEST(Renderer, KeepsItsDigitsInANationalGrid) {
  const TriangleMesh mesh = test::box({-0.5, -0.75, -0.25}, {0.625, 0.5, 0.5});
  const Eigen::Vector3d offset(4465280, 5337856, 512);  // representable, as is every corner with it
  TriangleMesh moved = mesh;
  for (Eigen::Vector3d& x : moved.vertices) x += offset;
  const Camera camera = random_camera(4, Projection::perspective);
  Camera moved_camera = camera;
  moved_camera.camera_from_world = camera.camera_from_world * Eigen::Translation3d(-offset);
  expect_hull(Renderer(moved).stencil(moved_camera), pixels_of(mesh.vertices, camera));
}

TEST(Renderer, DrawsPicturesLargerThanAFrameBuffer) {
  TriangleMesh triangle;
  triangle.vertices = {{-1, -1, 0}, {1, -0.9, 0}, {0.3, 1, 0}};
  triangle.faces = {{0, 1, 2}};
  Camera camera = look_at({0, 0, -3}, {0, 0, 0}, {0, 1, 0}, 9001, 7, 50);
  camera.K(0, 0) = 12000;
  camera.K(1, 1) = 8;
  expect_hull(Renderer(triangle).stencil(camera), pixels_of(triangle.vertices, camera));
  const Image8 shaded = Renderer(triangle).shaded(camera);
  EXPECT_EQ(shaded.at(0, 0), 255);
  EXPECT_LT(shaded.at(4500, 3), 255);
}

TEST(Renderer, RefusesBadMeshesAndSizes) {
  TriangleMesh mesh = test::sphere(1, 4);
  mesh.vertices[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { Renderer{mesh}; }).find("vertex 3"),
            std::string::npos);
  mesh = test::sphere(1, 4);
  mesh.faces[2][1] = 5000;
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { Renderer{mesh}; }).find("5000"), std::string::npos);
  Renderer renderer(test::sphere(1, 4));
  Camera camera = random_camera(1, Projection::perspective);
  camera.width = 20000;
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)renderer.stencil(camera); }).find("20000"),
            std::string::npos);
  camera.width = 0;
  EXPECT_FALSE(test::error_message(ErrorCode::input, [&] { (void)renderer.depth_map(camera); }).empty());
}

TEST(Renderer, SeveralWorkAtOnceWithoutDisturbingEachOther) {
  const TriangleMesh a = test::torus(0.7, 0.3);
  const TriangleMesh b = test::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  constexpr std::size_t views = 24;
  const auto camera_of = [](std::size_t i) {
    return random_camera(i, both_projections[i % 2], 4, 80 + static_cast<int>(i % 3), 60);
  };
  Renderer alone_a(a);
  std::vector<Image8> expected;
  for (std::size_t i = 0; i < views; ++i) expected.push_back(alone_a.stencil(camera_of(i)));

  Renderer with_b(b);
  Renderer with_a(a);
  for (std::size_t i = 0; i < views; ++i) {  // interleaved on one thread, other kinds of pictures between
    (void)with_b.depth_map(camera_of(i));
    EXPECT_EQ(with_a.stencil(camera_of(i)), expected[i]);
    (void)with_a.shaded(camera_of(i));
  }
  std::vector<Image8> found(views);
  parallel_for(views, 6, [&](std::size_t begin, std::size_t end) {
    Renderer own(a);
    for (std::size_t i = begin; i < end; ++i) found[i] = own.stencil(camera_of(i));
  });
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace drape::rendering
