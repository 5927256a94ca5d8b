// Every option of the exhaustive method does something.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bodies.hpp"
#include "drape/alignment/align.hpp"
#include "support.hpp"

namespace drape::alignment {
namespace {

class ExhaustiveOption : public ::testing::Test {
 protected:
  ExhaustiveOption() {
    options.exhaustive.stencil_px = 80;
    options.exhaustive.max_candidates_percent = 1;
    options.exhaustive.accept_overlap_percent = 100;
  }
  [[nodiscard]] Alignment run() const { return align_photo(mesh, {photo, prior}, options, 1, {}); }

  TriangleMesh mesh = knobbed_brick();
  Camera truth = view_of({20, 70, 130});
  Image8 photo = stencil_of(mesh, truth);
  std::optional<double> prior;
  AlignOptions options{.method = Method::exhaustive};
  ExhaustiveOptions& o = options.exhaustive;
};

TEST_F(ExhaustiveOption, DefaultsAreTheThesis) {
  const ExhaustiveOptions defaults;
  EXPECT_EQ(defaults.first_pass_step_deg, 45);
  EXPECT_FALSE(defaults.refine_start_deg);  // half the first pass's
  EXPECT_EQ(defaults.min_step_deg, 1);
  EXPECT_EQ(defaults.drop_step_deg, 6);
  EXPECT_EQ(defaults.drop_overlap_percent, 70);
  EXPECT_EQ(defaults.accept_overlap_percent, 95);
  EXPECT_EQ(defaults.max_candidates_percent, 100);
  EXPECT_EQ(defaults.translation_threshold_px, 0.1);
  EXPECT_FALSE(defaults.box_only);
  EXPECT_FALSE(defaults.scale_memory);
  EXPECT_EQ(defaults.fitness, Fitness::area);
}

TEST_F(ExhaustiveOption, AreAllDescribed) {
  AlignOptions all;
  std::vector<std::string> names;
  for (const Option& option : options_of(all)) names.push_back(option.name);
  EXPECT_EQ(names, (std::vector<std::string>{"method",
                                             "evidence",
                                             "projection",
                                             "focal_px",
                                             "fov_deg",
                                             "max_roll_deg",
                                             "initial_camera",
                                             "block",
                                             "share_focal",
                                             "first_pass_step_deg",
                                             "refine_start_deg",
                                             "min_step_deg",
                                             "drop_step_deg",
                                             "drop_overlap_percent",
                                             "accept_overlap_percent",
                                             "max_candidates_percent",
                                             "translation_threshold_px",
                                             "fov_range_deg",
                                             "fitness",
                                             "initial_scale",
                                             "box_only",
                                             "scale_memory",
                                             "stencil_px",
                                             "max_faces"}));
}

TEST_F(ExhaustiveOption, FirstPassStepSetsTheSizeOfTheList) {
  o.first_pass_step_deg = 90;
  EXPECT_EQ(run().metrics.candidates_listed, 32);
  o.first_pass_step_deg = 60;
  EXPECT_EQ(run().metrics.candidates_listed, 108);
}

TEST_F(ExhaustiveOption, RefinementHasAStepForEveryHalving) {
  // 45: 22.5, 11.25, 5.6, 2.8, 1.4. Each step fits 27 rotations, at least two stencils each.
  const std::int64_t five = run().metrics.stencils_drawn;
  o.refine_start_deg = 3;  // 3, 1.5
  const std::int64_t two = run().metrics.stencils_drawn;
  EXPECT_GE(five - two, 3 * 27 * 2);
  o.refine_start_deg.reset();
  o.min_step_deg = 5;  // 22.5, 11.25, 5.6
  const std::int64_t three = run().metrics.stencils_drawn;
  EXPECT_GT(three, two);
  EXPECT_GE(five - three, 2 * 27 * 2);
  EXPECT_LE(run().candidates.front().score, [&] {
    o.min_step_deg = 0.5;
    return run().candidates.front().score;
  }());
}

TEST_F(ExhaustiveOption, PoorCandidatesAreDroppedFromTheDropStepOn) {
  o.max_candidates_percent = 3;
  const Alignment kept = run();
  o.drop_overlap_percent = 100;
  const Alignment dropped = run();
  EXPECT_LT(dropped.metrics.stencils_drawn, kept.metrics.stencils_drawn);
  EXPECT_NE(dropped.reasons[1].find("were dropped"), std::string::npos);
  EXPECT_GT(dropped.overlap_percent, 60);  // the best of them is still given
  o.drop_step_deg = 0;
  EXPECT_EQ(run().metrics.stencils_drawn, kept.metrics.stencils_drawn);
}

TEST_F(ExhaustiveOption, SearchEndsWithTheFirstAcceptedCandidate) {
  o.max_candidates_percent = 5;
  EXPECT_EQ(run().metrics.candidates_tried, 13);  // 5 % of 256
  o.accept_overlap_percent = 50;
  EXPECT_EQ(run().metrics.candidates_tried, 1);
}

TEST_F(ExhaustiveOption, MaxCandidatesPercentIsOneAtLeast) {
  o.max_candidates_percent = 0;
  EXPECT_EQ(run().metrics.candidates_tried, 1);
  o.max_candidates_percent = 2;
  EXPECT_EQ(run().metrics.candidates_tried, 6);
}

TEST_F(ExhaustiveOption, TranslationThresholdSavesStencilsOrCostsOverlap) {
  const Alignment fine = run();
  o.translation_threshold_px = 100;  // never translated after the first look
  const Alignment coarse = run();
  EXPECT_LT(coarse.metrics.stencils_drawn, fine.metrics.stencils_drawn);
  EXPECT_LT(coarse.overlap_percent, fine.overlap_percent);
}

TEST_F(ExhaustiveOption, FieldOfViewIsSearchedByWholeDegrees) {
  o.min_step_deg = 20;  // a poor pose leaves something to be gained
  o.translation_threshold_px = 3;
  o.fov_range_deg = 0;
  const Alignment fixed = run();
  o.fov_range_deg = 5;
  const Alignment searched = run();
  EXPECT_GT(searched.candidates.front().score, fixed.candidates.front().score);
  EXPECT_EQ(searched.metrics.stencils_drawn - fixed.metrics.stencils_drawn, 10);
  // Everything else is kept: only the focal lengths differ, by the same factor, for a whole number of
  // degrees.
  EXPECT_EQ(searched.camera.camera_from_world.matrix(), fixed.camera.camera_from_world.matrix());
  const double factor = searched.camera.K(0, 0) / fixed.camera.K(0, 0);
  EXPECT_NEAR(searched.camera.K(1, 1) / fixed.camera.K(1, 1), factor, 1e-12);
  const double fov_deg =
      2 * std::atan(std::tan(22.5 * std::numbers::pi / 180) / factor) * 180 / std::numbers::pi;
  EXPECT_NEAR(fov_deg, std::round(fov_deg), 1e-9);
  EXPECT_NE(std::round(fov_deg), 45);
}

TEST_F(ExhaustiveOption, StartingFieldOfViewIsGivenOrThePhotosOr45) {
  o.fov_range_deg = 0;
  o.initial_scale = InitialScale::xy;  // keeps the canonical distance, which only the field of view sets
  const auto distance = [&] { return run().camera.camera_from_world.translation().z(); };
  const double at_45 = distance();
  options.fov_deg = 20;
  EXPECT_NEAR(distance() / at_45,
              std::tan(22.5 * std::numbers::pi / 180) / std::tan(10 * std::numbers::pi / 180), 0.2);
  options.fov_deg.reset();
  prior = 80 / std::tan(10 * std::numbers::pi / 180);  // 20 degrees as well
  EXPECT_GT(distance(), 1.9 * at_45);
  options.fov_deg = 45;
  EXPECT_NEAR(distance(), at_45, 1e-9);
}

TEST_F(ExhaustiveOption, InitialScaleByDistanceGivesSmallObjectsTheRightPerspective) {
  photo = stencil_of(mesh, view_of({90, 45, 315}, 20));  // small in the picture
  o.stencil_px = 160;
  const Alignment by_distance = run();
  o.initial_scale = InitialScale::xy;
  const Alignment in_xy = run();
  EXPECT_GT(by_distance.overlap_percent, in_xy.overlap_percent);
  EXPECT_GT(by_distance.camera.camera_from_world.translation().z(),
            1.3 * in_xy.camera.camera_from_world.translation().z());
}

TEST_F(ExhaustiveOption, ProjectionIsThatOfTheCameraFound) {
  options.projection = Camera::Projection::orthographic;
  photo = stencil_of(mesh, view_of({90, 45, 315}, 34, 85, 57, Camera::Projection::orthographic));
  const Alignment right = run();
  EXPECT_EQ(right.camera.projection, Camera::Projection::orthographic);
  EXPECT_NEAR(right.camera.K(0, 0), 34, 1);
  options.projection = Camera::Projection::perspective;
  EXPECT_GT(right.overlap_percent, run().overlap_percent);
}

TEST_F(ExhaustiveOption, FitnessOfOutlinesFindsThePoseToo) {
  photo = stencil_of(mesh, view_of({90, 45, 315}));
  std::vector<double> scores;
  for (const Fitness fitness : {Fitness::area, Fitness::list, Fitness::rays}) {
    o.fitness = fitness;
    const Alignment found = run();
    // At 80 pixels the object is about 50 x 30: one pixel all round would be 10 %.
    EXPECT_GT(found.overlap_percent, 90);
    scores.push_back(found.candidates.front().score);
  }
  EXPECT_NE(scores[0], scores[1]);
  EXPECT_NE(scores[1], scores[2]);
  EXPECT_NE(scores[0], scores[2]);
}

TEST_F(ExhaustiveOption, BoxOnlyForgivesWhatStandsOutOfTheBox) {
  const Alignment whole = run();
  o.box_only = true;
  const Alignment box = run();
  EXPECT_GE(box.candidates.front().score, whole.candidates.front().score);
  EXPECT_NE(box.camera.P(), whole.camera.P());
}

TEST_F(ExhaustiveOption, ScaleMemoryStartsFromTheLastScale) {
  const Alignment fresh = run();
  o.scale_memory = true;
  const Alignment memory = run();
  EXPECT_EQ(memory.metrics.candidates_listed, 512);  // what was before decides: no cell is like another
  EXPECT_NE(memory.camera.P(), fresh.camera.P());
  EXPECT_GT(memory.overlap_percent, 80);
}

TEST_F(ExhaustiveOption, StencilPxSetsHowFinelyStencilsAreCompared) {
  const Alignment coarse = run();
  o.stencil_px = 160;
  const Alignment fine = run();
  EXPECT_NE(fine.camera.P(), coarse.camera.P());
}

TEST_F(ExhaustiveOption, MaxFacesSimplifiesTheSearchButNotTheOverlap) {
  mesh = test::torus(1, 0.4, 60, 30);
  for (Eigen::Vector3d& x : mesh.vertices)
    if (x.x() > 0) x.x() *= 1.5;
  photo = stencil_of(mesh, view_of({30, 45, 0}));
  o.min_step_deg = 3;
  o.max_faces = 200;
  const Alignment simple = run();
  o.max_faces = 100000;
  const Alignment full = run();
  EXPECT_NE(simple.camera.P(), full.camera.P());
  EXPECT_GT(simple.overlap_percent, full.overlap_percent - 4);
}

}  // namespace
}  // namespace drape::alignment
