#include "drape/alignment/align.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>

#include "bodies.hpp"
#include "drape/alignment/overlap.hpp"
#include "drape/base/parallel.hpp"
#include "support.hpp"

namespace drape::alignment {
namespace {

// Small stencils and a tenth of the candidates: seconds become tenths.
AlignOptions quick_options() {
  AlignOptions options;
  options.method = Method::exhaustive;
  options.exhaustive.stencil_px = 96;
  options.exhaustive.max_candidates_percent = 10;
  return options;
}

Alignment align(const TriangleMesh& mesh, const Image8& stencil, const AlignOptions& options) {
  return align_photo(mesh, {stencil, std::nullopt}, options, 1, {});
}

void expect_same(const Alignment& a, const Alignment& b) {
  EXPECT_EQ(a.camera.P(), b.camera.P());
  EXPECT_EQ(a.overlap_percent, b.overlap_percent);
  EXPECT_EQ(a.reasons, b.reasons);
  EXPECT_EQ(a.metrics.candidates_tried, b.metrics.candidates_tried);
  EXPECT_EQ(a.metrics.stencils_drawn, b.metrics.stencils_drawn);
  ASSERT_EQ(a.candidates.size(), b.candidates.size());
  for (std::size_t i = 0; i < a.candidates.size(); ++i) {
    EXPECT_EQ(a.candidates[i].camera.P(), b.candidates[i].camera.P());
    EXPECT_EQ(a.candidates[i].score, b.candidates[i].score);
  }
}

TEST(Align, FindsAPoseOnItsGrid) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = view_of({90, 45, 315});
  const Alignment found = align(mesh, stencil_of(mesh, truth), quick_options());
  EXPECT_GT(found.overlap_percent, 97);
  EXPECT_LT(rotation_between_deg(found.camera, truth), 3);
  EXPECT_EQ(found.metrics.candidates_listed, 256);
  EXPECT_LE(found.metrics.pass1_seconds, found.metrics.total_seconds);
  EXPECT_EQ(found.camera.width, 160);
  EXPECT_EQ(found.camera.height, 120);
}

TEST(Align, FindsPosesBetweenTheGridsCells) {
  const TriangleMesh mesh = knobbed_brick();
  AlignOptions options = quick_options();
  options.exhaustive.accept_overlap_percent = 97.5;
  for (const Eigen::Vector3d& angles : {Eigen::Vector3d(20, 70, 130), Eigen::Vector3d(290, 110, 250)}) {
    const Camera truth = view_of(angles);
    const Alignment found = align(mesh, stencil_of(mesh, truth), options);
    EXPECT_GT(found.overlap_percent, 96) << angles.transpose();
    EXPECT_LT(rotation_between_deg(found.camera, truth), 8) << angles.transpose();
  }
}

TEST(Align, OverlapIsThatOfTheReturnedCameraAtThePhotosSize) {
  const TriangleMesh mesh = knobbed_brick();
  const Image8 photo = stencil_of(mesh, view_of({20, 70, 130}));
  const Alignment found = align(mesh, photo, quick_options());
  EXPECT_EQ(found.overlap_percent, overlap_percent(stencil_of(mesh, found.camera), photo));
  EXPECT_EQ(found.candidates.front().camera.P(), found.camera.P());
}

TEST(Align, AlwaysAsksForReviewAndSaysWhy) {
  const TriangleMesh mesh = knobbed_brick();
  AlignOptions options = quick_options();
  const Alignment found = align(mesh, stencil_of(mesh, view_of({90, 45, 315})), options);
  EXPECT_EQ(found.verdict, Verdict::review);
  ASSERT_FALSE(found.reasons.empty());
  EXPECT_NE(found.reasons.front().find("does not prove"), std::string::npos);
  options.exhaustive.accept_overlap_percent = 100;
  const Alignment exhausted = align(mesh, stencil_of(mesh, view_of({20, 70, 130})), options);
  ASSERT_GE(exhausted.reasons.size(), 2U);
  EXPECT_NE(exhausted.reasons[1].find("26 candidates"), std::string::npos);
  ASSERT_GE(exhausted.candidates.size(), 2U);
  for (std::size_t i = 1; i < exhausted.candidates.size(); ++i) {
    EXPECT_GE(exhausted.candidates[i - 1].score, exhausted.candidates[i].score);
    EXPECT_GT(rotation_between_deg(exhausted.candidates[i].camera, exhausted.camera), 14.9);
  }
}

TEST(Align, IsTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = knobbed_brick();
  const Image8 photo = stencil_of(mesh, view_of({200, 30, 10}));
  for (const bool memory : {false, true}) {
    AlignOptions options = quick_options();
    options.exhaustive.max_candidates_percent = 2;
    options.exhaustive.first_pass_step_deg = memory ? 90 : 45;
    options.exhaustive.scale_memory = memory;
    set_thread_count(1);
    const Alignment one = align(mesh, photo, options);
    set_thread_count(3);
    const Alignment three = align(mesh, photo, options);
    set_thread_count(0);
    expect_same(one, three);
  }
}

TEST(Align, DoesNotDependOnTheMeshsUnitOrPlace) {
  const TriangleMesh mesh = knobbed_brick();
  const Image8 photo = stencil_of(mesh, view_of({90, 45, 315}));
  TriangleMesh moved = mesh;
  for (Eigen::Vector3d& x : moved.vertices) x = 1024 * x + Eigen::Vector3d(8192, -4096, 512);
  const Alignment here = align(mesh, photo, quick_options());
  const Alignment there = align(moved, photo, quick_options());
  EXPECT_NEAR(here.overlap_percent, there.overlap_percent, 0.3);
  for (std::size_t v = 0; v < mesh.vertices.size(); v += 7)
    EXPECT_LT(
        (here.camera.project(mesh.vertices[v]).pixel - there.camera.project(moved.vertices[v]).pixel).norm(),
        0.5);
}

TEST(Align, LeavesUnknownPixelsOut) {
  const TriangleMesh mesh = knobbed_brick();
  const Camera truth = view_of({90, 45, 315});
  Image8 photo = stencil_of(mesh, truth);
  for (int y = 0; y < photo.height(); ++y)
    for (int x = 78; x < 88; ++x) photo.at(x, y) = stencil::unknown;  // a pole stood before it
  const Alignment found = align(mesh, photo, quick_options());
  EXPECT_GT(found.overlap_percent, 95);
  EXPECT_LT(rotation_between_deg(found.camera, truth), 5);
  Image8 cut = photo;
  for (std::uint8_t& value : cut.data())
    if (value == stencil::unknown) value = stencil::background;
  AlignOptions options = quick_options();
  options.exhaustive.max_candidates_percent = 1;
  EXPECT_LT(align(mesh, cut, options).overlap_percent, 90);
}

TEST(Align, StopsWhenAskedTo) {
  const std::atomic<bool> stop{true};
  const TriangleMesh mesh = knobbed_brick();
  const Image8 photo = stencil_of(mesh, view_of({90, 45, 315}));
  EXPECT_THROW((void)align_photo(mesh, {photo, std::nullopt}, quick_options(), 1, Progress({}, &stop)),
               Interrupted);
}

TEST(Align, ReportsProgressThatGrows) {
  std::vector<double> fractions;
  const Progress progress([&](double fraction, std::string_view) { fractions.push_back(fraction); }, nullptr);
  const TriangleMesh mesh = knobbed_brick();
  const Image8 photo = stencil_of(mesh, view_of({90, 45, 315}));
  AlignOptions options = quick_options();
  options.exhaustive.max_candidates_percent = 2;
  (void)align_photo(mesh, {photo, std::nullopt}, options, 1, progress);
  ASSERT_GT(fractions.size(), 8U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_DOUBLE_EQ(fractions.back(), 1);
}

// ---- nasty input

std::string refusal(const TriangleMesh& mesh, const Image8& stencil) {
  return test::error_message(ErrorCode::input, [&] { (void)align(mesh, stencil, quick_options()); });
}

TEST(AlignNasty, EmptyStencil) {
  EXPECT_NE(refusal(knobbed_brick(), Image8(160, 120, 1, stencil::background)).find("no object"),
            std::string::npos);
  EXPECT_NE(refusal(knobbed_brick(), Image8(160, 120, 1, stencil::unknown)).find("no object"),
            std::string::npos);
  EXPECT_FALSE(refusal(knobbed_brick(), Image8()).empty());
}

TEST(AlignNasty, FullStencil) {
  EXPECT_NE(refusal(knobbed_brick(), Image8(160, 120, 1, stencil::object)).find("no background"),
            std::string::npos);
}

TEST(AlignNasty, OnePixelStencil) {
  Image8 photo(160, 120, 1, stencil::background);
  photo.at(80, 60) = stencil::object;
  EXPECT_NE(refusal(knobbed_brick(), photo).find("too small"), std::string::npos);
}

TEST(AlignNasty, StencilThatIsNone) {
  EXPECT_NE(refusal(knobbed_brick(), Image8(160, 120, 3, 0)).find("channel"), std::string::npos);
  EXPECT_NE(refusal(knobbed_brick(), Image8(160, 120, 1, 37)).find("37"), std::string::npos);
}

TEST(AlignNasty, SquareStencil) {
  Image8 photo(160, 120, 1, stencil::background);
  for (int y = 30; y < 90; ++y)
    for (int x = 50; x < 110; ++x) photo.at(x, y) = stencil::object;
  const Alignment found = align(test::box({-1, -1, -1}, {1, 1, 1}), photo, quick_options());
  EXPECT_GT(found.overlap_percent, 95);
  EXPECT_EQ(found.verdict, Verdict::review);
}

TEST(AlignNasty, StencilThatTouchesTheBorder) {
  const TriangleMesh mesh = knobbed_brick();
  const Alignment found =
      align(mesh, stencil_of(mesh, view_of({90, 45, 315}, 40, 140, 100)), quick_options());
  EXPECT_GT(found.overlap_percent, 50);
  EXPECT_TRUE(found.camera.P().allFinite());
}

TEST(AlignNasty, OneTriangle) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.2, 0.8, 0}};
  mesh.faces = {{0, 1, 2}};
  const Image8 photo = stencil_of(mesh, view_of({0, 0, 0}, 60));
  const Alignment found = align(mesh, photo, quick_options());
  EXPECT_GT(found.overlap_percent, 90);
  EXPECT_TRUE(found.camera.P().allFinite());
}

TEST(AlignNasty, FlatMesh) {
  const TriangleMesh mesh = test::box({-1, -0.5, 0}, {1, 0.5, 0});
  const Alignment found = align(mesh, stencil_of(mesh, view_of({20, 30, 10})), quick_options());
  EXPECT_GT(found.overlap_percent, 90);
  EXPECT_TRUE(found.camera.P().allFinite());
}

TEST(AlignNasty, BrokenMeshes) {
  const Image8 photo = stencil_of(knobbed_brick(), view_of({90, 45, 315}));
  TriangleMesh mesh = knobbed_brick();
  mesh.vertices[4].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(mesh, photo).find("vertex 4"), std::string::npos);
  EXPECT_NE(refusal(TriangleMesh{}, photo).find("no faces"), std::string::npos);
  mesh = TriangleMesh{};
  mesh.vertices.assign(3, Eigen::Vector3d(1, 2, 3));
  mesh.faces = {{0, 1, 2}};
  EXPECT_NE(refusal(mesh, photo).find("one point"), std::string::npos);
  EXPECT_FALSE(test::error_message(ErrorCode::input, [&] {
                 (void)align_photo(knobbed_brick(), {photo, -5.0}, quick_options(), 1, {});
               }).empty());
}

TEST(AlignNasty, MeshThatShowsNothing) {
  // All its faces are needles without area: no stencil has a pixel.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.faces = {{0, 1, 2}};
  const Alignment found = align(mesh, stencil_of(knobbed_brick(), view_of({90, 45, 315})), quick_options());
  EXPECT_EQ(found.overlap_percent, 0);
  ASSERT_GE(found.reasons.size(), 2U);
  EXPECT_NE(found.reasons[1].find("dropped"), std::string::npos);
}

}  // namespace
}  // namespace drape::alignment
