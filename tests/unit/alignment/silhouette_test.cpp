// Method::silhouette from mesh and stencil to camera and verdict.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "bodies.hpp"
#include "drape/alignment/align.hpp"
#include "drape/alignment/overlap.hpp"
#include "drape/base/parallel.hpp"
#include "support.hpp"

namespace drape::alignment {
namespace {

Alignment align(const TriangleMesh& mesh, const PhotoEvidence& evidence, const AlignOptions& options = {}) {
  return align_photo(mesh, evidence, options, 1, {});
}
Alignment align(const TriangleMesh& mesh, const Image8& stencil) {
  return align(mesh, PhotoEvidence{stencil});
}

bool mentions(const Alignment& found, const std::string& words) {
  for (const std::string& reason : found.reasons)
    if (reason.find(words) != std::string::npos) return true;
  return false;
}

// The photo of `view_of` four times as large.
Camera large_view(const Eigen::Vector3d& euler_deg) {
  return view_of(euler_deg).resized(640, 480);
}

TEST(Silhouette, FindsAnyPoseToATenthOfADegree) {
  const TriangleMesh mesh = knobbed_brick();
  for (const Eigen::Vector3d& angles :
       {Eigen::Vector3d(20, 70, 130), Eigen::Vector3d(290, 110, 250), Eigen::Vector3d(200, 30, 10)}) {
    const Camera truth = large_view(angles);
    const Image8 photo = stencil_of(mesh, truth);
    const Alignment found = align(mesh, photo);
    EXPECT_LT(rotation_between_deg(found.camera, truth), 0.1) << angles.transpose();
    EXPECT_GT(overlap_percent(stencil_of(mesh, found.camera), photo), 99.9);
    EXPECT_NEAR(found.overlap_percent, overlap_percent(stencil_of(mesh, found.camera), photo), 0.2);
    EXPECT_NEAR(found.camera.K(0, 0), truth.K(0, 0), 0.02 * truth.K(0, 0));
    EXPECT_EQ(found.verdict, Verdict::accept) << found.reasons.front();
    ASSERT_TRUE(found.sigma.has_value());
    EXPECT_LT(found.sigma->rotation_deg, 0.2);
    EXPECT_LT(rotation_between_deg(found.camera, truth), 4 * found.sigma->rotation_deg);
    EXPECT_LT(found.boundary_error_px.value(), 0.6);
  }
}

TEST(Silhouette, LargerPhotosGiveBetterPoses) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera small = view_of({20, 70, 130});
  const Camera large = small.resized(1600, 1200);
  const double coarse = rotation_between_deg(align(mesh, stencil_of(mesh, small)).camera, small);
  const double fine = rotation_between_deg(align(mesh, stencil_of(mesh, large)).camera, large);
  EXPECT_LT(fine, 0.05);
  EXPECT_LT(fine, coarse);
}

TEST(Silhouette, OrthographicCamera) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = view_of({20, 70, 130}, 34, 85, 57, Camera::Projection::orthographic).resized(640, 480);
  AlignOptions options;
  options.projection = Camera::Projection::orthographic;
  const Alignment found = align(mesh, {stencil_of(mesh, truth)}, options);
  EXPECT_EQ(found.camera.projection, Camera::Projection::orthographic);
  EXPECT_GT(found.overlap_percent, 99.5);
}

TEST(Silhouette, KeepsAFocalLengthThatIsGiven) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = large_view({290, 110, 250});
  const Image8 photo = stencil_of(mesh, truth);
  AlignOptions options;
  options.focal_px = truth.K(0, 0);
  EXPECT_NEAR(align(mesh, {photo}, options).camera.K(0, 0), truth.K(0, 0), 1e-6 * truth.K(0, 0));
  options = {};
  options.fov_deg = 45;
  EXPECT_NEAR(align(mesh, {photo}, options).camera.K(0, 0), truth.K(0, 0), 1e-6 * truth.K(0, 0));
  // A wrong hint of the file is overruled.
  PhotoEvidence misled{photo, 2 * truth.K(0, 0)};
  EXPECT_NEAR(align(mesh, misled).camera.K(0, 0), truth.K(0, 0), 0.03 * truth.K(0, 0));
}

TEST(Silhouette, UsesAKnownLensWithItsDistortion) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = large_view({20, 70, 130});
  KnownLens lens;
  lens.K = truth.K;
  lens.distortion = {-0.25, 0.05, 0, 0};
  // The photo through the lens: each pixel looks up where the ideal camera shows it.
  const Image8 ideal = stencil_of(mesh, truth);
  Image8 photo(640, 480, 1, stencil::background);
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const Eigen::Vector2d target((x + 0.5 - lens.K(0, 2)) / lens.K(0, 0),
                                   (y + 0.5 - lens.K(1, 2)) / lens.K(1, 1));
      Eigen::Vector2d at = target;
      for (int i = 0; i < 20; ++i) {
        const double r2 = at.squaredNorm();
        at = target / (1 - 0.25 * r2 + 0.05 * r2 * r2);
      }
      const int u = static_cast<int>(std::floor(lens.K(0, 0) * at.x() + lens.K(0, 2)));
      const int v = static_cast<int>(std::floor(lens.K(1, 1) * at.y() + lens.K(1, 2)));
      if (ideal.contains(u, v)) photo.at(x, y) = ideal.at(u, v);
    }
  PhotoEvidence evidence{photo};
  evidence.lens = lens;
  const Alignment found = align(mesh, evidence);
  EXPECT_LT(rotation_between_deg(found.camera, truth), 0.3);
  EXPECT_LT((found.camera.K - truth.K).norm(), 1e-6 * truth.K.norm());
}

TEST(Silhouette, StartsWhereItIsTold) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = large_view({20, 70, 130});
  const Image8 photo = stencil_of(mesh, truth);
  PhotoEvidence evidence{photo};
  evidence.initial_camera = truth;
  evidence.initial_camera->camera_from_world.linear() =
      Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()) * truth.camera_from_world.linear();
  const Alignment found = align(mesh, evidence);
  EXPECT_LT(rotation_between_deg(found.camera, truth), 0.3);
  EXPECT_EQ(found.metrics.candidates_listed, 0);
  evidence.initial_camera->camera_from_world.translation().z() -= 100;
  EXPECT_FALSE(test::error_message(ErrorCode::config, [&] { (void)align(mesh, evidence); }).empty());
}

TEST(Silhouette, TriesOnlyUprightPosesWhereThePhotoIs) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = large_view({20, 70, 130});
  const Image8 photo = stencil_of(mesh, truth);
  PhotoEvidence evidence{photo};
  AlignOptions options;
  options.max_roll_deg = 20;
  evidence.up = truth.camera_from_world.linear().transpose() * Eigen::Vector3d(0, -1, 0);
  EXPECT_LT(rotation_between_deg(align(mesh, evidence, options).camera, truth), 0.3);
  evidence.up = -*evidence.up;  // upside down: the right pose is not allowed
  EXPECT_GT(rotation_between_deg(align(mesh, evidence, options).camera, truth), 20);
}

TriangleMesh bumped_torus() {
  TriangleMesh mesh = test::torus(1, 0.4, 60, 40);
  const TriangleMesh bump = test::box({0.9, -0.3, 0}, {1.8, 0.1, 0.5});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), bump.vertices.begin(), bump.vertices.end());
  for (const Face& f : bump.faces) mesh.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
  return mesh;
}

TEST(Silhouette, ForgivesHolesOfTheMeshButNotOfTheObject) {
  const TriangleMesh mesh = bumped_torus();
  const Camera truth = view_of({185, 5, 40}, 24).resized(640, 480);
  const Image8 photo = stencil_of(mesh, truth);
  // Both walls are missing in a patch, so that one sees through.
  TriangleMesh holed = mesh;
  std::vector<std::uint8_t> keep(mesh.faces.size(), 1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Eigen::Vector3d& x = mesh.vertices[mesh.faces[f][0]];
    if ((x.head<2>() - Eigen::Vector2d(-1, 0)).norm() < 0.3) keep[f] = 0;
  }
  holed = with_faces(mesh, keep);
  const Alignment found = align(holed, photo);
  EXPECT_LT(rotation_between_deg(found.camera, truth), 0.5);
  EXPECT_GT(found.overlap_percent, 99.5);
  EXPECT_LT(overlap_percent(stencil_of(holed, found.camera), photo), 99);
  // The torus's own opening is clear in the photo; a photo without it does not fit.
  Image8 closed = photo;
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      const Eigen::Vector2d middle = truth.project(Eigen::Vector3d::Zero()).pixel;
      if ((Eigen::Vector2d(x, y) - middle).norm() < 80) closed.at(x, y) = stencil::object;
    }
  EXPECT_LT(align(mesh, closed).overlap_percent, 98);
}

// What the scan has of it is the other side: its inner side fills the view, and little holds the outline.
TEST(Silhouette, DoubtsAPoseThatLooksIntoAnOpenMesh) {
  const TriangleMesh mesh = bumped_torus();
  const Camera truth = view_of({185, 5, 40}, 24).resized(640, 480);
  const Image8 photo = stencil_of(mesh, truth);
  for (const bool from_within : {false, true}) {
    std::vector<std::uint8_t> keep;
    for (const Face& f : mesh.faces) {
      const Eigen::Vector3d middle = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
      keep.push_back((middle.z() < 0.02) == from_within ? 1 : 0);
    }
    const Alignment found = align(with_faces(mesh, keep), photo);
    ASSERT_TRUE(found.outline);
    EXPECT_EQ(found.verdict, from_within ? Verdict::review : Verdict::accept);
    EXPECT_NEAR(found.outline->inner_side, from_within ? 1 : 0, 0.1);
    EXPECT_EQ(found.reasons.front().find("inner side") != std::string::npos, from_within);
    EXPECT_LT(rotation_between_deg(found.camera, truth), from_within ? 5 : 0.5);
  }
}

TEST(Silhouette, ForgivesHolesThatTheOutlinePassesThrough) {
  const TriangleMesh mesh = bumped_torus();
  std::vector<std::uint8_t> keep;
  for (const Face& f : mesh.faces) {
    const Eigen::Vector3d& x = mesh.vertices[f[0]];
    const bool outer = x.head<2>().norm() > 1.05;
    keep.push_back(outer && std::abs(std::atan2(x.y(), -x.x())) < 1 ? 0 : 1);
  }
  const TriangleMesh cut = with_faces(mesh, keep);
  for (const Eigen::Vector3d& angles : {Eigen::Vector3d(185, 5, 40), Eigen::Vector3d(20, 10, 0),
                                        Eigen::Vector3d(150, 20, 70), Eigen::Vector3d(60, 30, 110)}) {
    const Camera truth = view_of(angles, 24).resized(640, 480);
    const Alignment found = align(cut, stencil_of(mesh, truth));
    EXPECT_LT(rotation_between_deg(found.camera, truth), 0.3) << angles.transpose();
    EXPECT_EQ(found.verdict, Verdict::accept) << found.reasons.front();
    EXPECT_GT(found.inlier_fraction, 0.9) << angles.transpose();
    EXPECT_GT(found.overlap_percent, 98) << angles.transpose();
  }
}

// Gives the pixels `value`, those of the least key first, until they are a share of the object's.
template <class Key>
void change(Image8& photo, double share, std::uint8_t value, Key key) {
  std::vector<std::pair<double, std::size_t>> others;
  double object = 0;
  for (int y = 0; y < photo.height(); ++y)
    for (int x = 0; x < photo.width(); ++x) {
      object += photo.at(x, y) == stencil::object ? 1 : 0;
      if (photo.at(x, y) != value)
        others.emplace_back(key(Eigen::Vector2d(x, y)), static_cast<std::size_t>(y * photo.width() + x));
    }
  std::sort(others.begin(), others.end());
  for (std::size_t i = 0; static_cast<double>(i) < share * object; ++i)
    photo.data()[others[i].second] = value;
}

TEST(Silhouette, SeesThroughAFifthThatIsMissing) {
  const TriangleMesh mesh = knobbed_brick();
  for (const Eigen::Vector3d& angles : {Eigen::Vector3d(290, 110, 250), Eigen::Vector3d(200, 30, 10)}) {
    const Camera truth = large_view(angles);
    const Image8 whole = stencil_of(mesh, truth);
    for (const Eigen::Vector2d& side : {Eigen::Vector2d(0, -1), Eigen::Vector2d(-0.6, 0.8)}) {
      Image8 photo = whole;  // behind a wall
      change(photo, 0.2, stencil::background, [&](const Eigen::Vector2d& x) { return side.dot(x); });
      const Alignment found = align(mesh, photo);
      EXPECT_LT(rotation_between_deg(found.camera, truth), 2)
          << angles.transpose() << ' ' << side.transpose();
      EXPECT_NE(found.verdict, Verdict::reject);
    }
    Image8 photo = whole;  // behind a ball
    const Eigen::Vector2d rim = truth.project(mesh.vertices.front()).pixel;
    change(photo, 0.2, stencil::background, [&](const Eigen::Vector2d& x) { return (x - rim).norm(); });
    EXPECT_LT(rotation_between_deg(align(mesh, photo).camera, truth), 2) << angles.transpose();
  }
}

TEST(Silhouette, SeesPastAFifthThatIsJoinedToIt) {
  const TriangleMesh mesh = knobbed_brick();
  for (const Eigen::Vector3d& angles : {Eigen::Vector3d(20, 70, 130), Eigen::Vector3d(200, 30, 10)}) {
    const Camera truth = large_view(angles);
    Image8 photo = stencil_of(mesh, truth);
    const Eigen::Vector2d rim = truth.project(mesh.vertices.front()).pixel;
    change(photo, 0.2, stencil::object, [&](const Eigen::Vector2d& x) { return (x - rim).norm(); });
    EXPECT_LT(rotation_between_deg(align(mesh, photo).camera, truth), 2) << angles.transpose();
  }
}

TEST(Silhouette, LeavesUnknownPixelsAndTheFrameOut) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = large_view({90, 45, 315});
  Image8 photo = stencil_of(mesh, truth);
  for (int y = 0; y < 480; ++y)
    for (int x = 312; x < 352; ++x) photo.at(x, y) = stencil::unknown;  // a pole stood before it
  EXPECT_LT(rotation_between_deg(align(mesh, photo).camera, truth), 0.5);
  const Camera cut = view_of({90, 45, 315}, 40, 140, 60).resized(640, 480);
  EXPECT_LT(rotation_between_deg(align(mesh, stencil_of(mesh, cut)).camera, cut), 2);
}

TEST(Silhouette, RejectsAnotherObject) {
  const Image8 photo = stencil_of(test::torus(1, 0.4), large_view({40, 30, 0}));
  const Alignment found = align(knobbed_brick(), photo);
  EXPECT_NE(found.verdict, Verdict::accept);
  ASSERT_FALSE(found.reasons.empty());
}

TEST(Silhouette, DoesNotAcceptABodyOfRotation) {
  TriangleMesh mesh = test::sphere(1, 24);
  for (Eigen::Vector3d& x : mesh.vertices) x.z() *= 1.8 + 0.3 * x.z();
  const Alignment found = align(mesh, stencil_of(mesh, large_view({70, 20, 30})));
  EXPECT_EQ(found.verdict, Verdict::review);
  EXPECT_TRUE(mentions(found, "free about the axis")) << found.reasons.front() << found.sigma->rotation_deg;
}

// Each view of any body fits a disc alike at all of its rolls.
TEST(Silhouette, FindsABodyOfRotationSeenAlongItsAxis) {
  TriangleMesh mesh = test::sphere(1, 16);
  for (Eigen::Vector3d& x : mesh.vertices) x.z() *= 1.8 + 0.3 * x.z();
  Image8 disc(200, 200, 1, stencil::background);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      if (std::hypot(x + 0.5 - 100, y + 0.5 - 100) < 60) disc.at(x, y) = stencil::object;
  const Alignment found = align(mesh, disc);
  EXPECT_EQ(found.verdict, Verdict::review);
  EXPECT_GT(found.overlap_percent, 98);
}

TEST(Silhouette, DoesNotAcceptOneOfTwoMirrorTwins) {
  // Under an orthographic camera a mirror-symmetric body has two poses of exactly one outline.
  TriangleMesh mesh = test::box({-1, -0.6, -0.35}, {1, 0.6, 0.35});
  const TriangleMesh fin = test::box({0.3, -0.1, 0.35}, {0.8, 0.1, 1.0});
  for (const Face& f : fin.faces) mesh.faces.push_back({f[0] + 8, f[1] + 8, f[2] + 8});
  mesh.vertices.insert(mesh.vertices.end(), fin.vertices.begin(), fin.vertices.end());
  const Camera truth = view_of({20, 70, 130}, 34, 85, 57, Camera::Projection::orthographic).resized(640, 480);
  AlignOptions options;
  options.projection = Camera::Projection::orthographic;
  const Alignment found = align(mesh, {stencil_of(mesh, truth)}, options);
  EXPECT_EQ(found.verdict, Verdict::review);
  ASSERT_GE(found.candidates.size(), 2U);
  double nearest = 180;
  for (const AlignmentCandidate& candidate : found.candidates)
    nearest = std::min(nearest, rotation_between_deg(candidate.camera, truth));
  EXPECT_LT(nearest, 0.5);
  // The light inside tells them apart.
  const Image8 photo = lit_photo(mesh, truth);
  PhotoEvidence evidence{stencil_of(mesh, truth)};
  evidence.photo = &photo;
  const Alignment told = align(mesh, evidence, options);
  EXPECT_EQ(told.verdict, Verdict::accept) << told.reasons.front();
  EXPECT_LT(rotation_between_deg(told.camera, truth), 0.5);
  EXPECT_TRUE(told.outline->by_photo);
}

TEST(Silhouette, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = knobbed_brick();
  const Image8 photo = stencil_of(mesh, view_of({200, 30, 10}));
  set_thread_count(1);
  const Alignment one = align(mesh, photo);
  set_thread_count(3);
  const Alignment three = align(mesh, photo);
  set_thread_count(0);
  EXPECT_EQ(one.camera.P(), three.camera.P());
  EXPECT_EQ(one.reasons, three.reasons);
  ASSERT_EQ(one.candidates.size(), three.candidates.size());
  for (std::size_t i = 0; i < one.candidates.size(); ++i)
    EXPECT_EQ(one.candidates[i].camera.P(), three.candidates[i].camera.P());
}

TEST(Silhouette, StopsWhenAskedTo) {
  const std::atomic<bool> stop{true};
  const Image8 photo = stencil_of(knobbed_brick(), view_of({90, 45, 315}));
  EXPECT_THROW((void)align_photo(knobbed_brick(), {photo}, {}, 1, Progress({}, &stop)), Interrupted);
}

// ---- nasty input

TEST(SilhouetteNasty, StencilsWithoutAnOutline) {
  const auto refusal = [](const Image8& photo) {
    return test::error_message(ErrorCode::input, [&] { (void)align(knobbed_brick(), photo); });
  };
  Image8 photo(160, 120, 1, stencil::background);
  EXPECT_NE(refusal(photo).find("no object"), std::string::npos);
  EXPECT_NE(refusal(Image8(160, 120, 1, stencil::object)).find("no background"), std::string::npos);
  photo.at(80, 60) = stencil::object;
  EXPECT_NE(refusal(photo).find("too small"), std::string::npos);
}

TEST(SilhouetteNasty, BodiesWithoutThickness) {
  TriangleMesh triangle;
  triangle.vertices = {{0, 0, 0}, {1, 0, 0}, {0.2, 0.8, 0}};
  triangle.faces = {{0, 1, 2}};
  TriangleMesh needle;
  needle.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  needle.faces = {{0, 1, 2}};
  for (const TriangleMesh& mesh : {triangle, test::box({-1, -0.5, 0}, {1, 0.5, 0}), needle}) {
    const Alignment found = align(mesh, stencil_of(triangle, view_of({20, 30, 10}, 60)));
    EXPECT_TRUE(found.camera.P().allFinite());
    EXPECT_NE(found.verdict, Verdict::accept);
    EXPECT_FALSE(found.reasons.empty());
  }
}

TEST(SilhouetteNasty, ASquare) {
  Image8 photo(160, 120, 1, stencil::background);
  for (int y = 30; y < 90; ++y)
    for (int x = 50; x < 110; ++x) photo.at(x, y) = stencil::object;
  const Alignment found = align(test::box({-1, -1, -1}, {1, 1, 1}), photo);
  EXPECT_GT(found.overlap_percent, 97);
  EXPECT_NE(found.verdict, Verdict::accept);  // a cube has 24 such poses
}

TEST(SilhouetteNasty, SpecksBesideTheObject) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = large_view({20, 70, 130});
  Image8 photo = stencil_of(mesh, truth);
  for (int i = 0; i < 40; ++i) photo.at(5 + 16 * i % 630, 3 + 37 * i % 470) = stencil::object;
  EXPECT_LT(rotation_between_deg(align(mesh, photo).camera, truth), 2);
}

}  // namespace
}  // namespace drape::alignment
