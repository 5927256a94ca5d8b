// The search by colours over a whole photo: places, what is cut off, what is inside.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bodies.hpp"
#include "coarse_search.hpp"
#include "color_appearance.hpp"
#include "color_evidence.hpp"
#include "drape/base/random.hpp"
#include "outline_pose.hpp"

namespace drape::alignment {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

// The mesh in orange on grey, with noise.
struct Sought {
  explicit Sought(double middle_x = 85) : truth(view_of({20, 70, 130}, 34, middle_x).resized(480, 360)) {}

  const Camera truth;
  const TriangleMesh mesh = knobbed_brick();
  const UnitSphere sphere = unit_sphere(mesh);
  const OutlineMesh outline = outline_mesh(mesh, sphere);
  const PhotoPlane plane{480, 360, {}};
  LensPrior lens = [] {
    LensPrior prior;
    prior.photo_width_px = 480;
    return prior;
  }();
  const OutlinePose pose = *pose_of(truth, sphere, plane.principal_px());
  const Image8 rgb = photo();
  const ColorEvidence evidence{rgb, plane, {}};

  [[nodiscard]] Image8 photo() const {
    const Image8 silhouette = stencil_of(mesh, truth);
    Image8 picture(480, 360, 3);
    Rng rng(5);
    for (int y = 0; y < 360; ++y)
      for (int x = 0; x < 480; ++x) {
        const bool object = silhouette.at(x, y) == stencil::object;
        const std::array<int, 3> color = object ? std::array{220, 130, 40} : std::array{90, 95, 100};
        for (int c = 0; c < 3; ++c)
          picture.at(x, y, c) =
              static_cast<std::uint8_t>(color[static_cast<std::size_t>(c)] + rng.uniform(-12, 12));
      }
    return picture;
  }
};

// A part of an object is often found first: its colours stand out more than the whole's do.
TEST(CoarseSearch, ReachesTheWholeFromAPartOfIt) {
  const Sought sought;
  OutlinePose part = sought.pose;
  part.scale *= 0.6;
  part.shift += Eigen::Vector2d(0.15, -0.1) * sought.pose.scale;
  part.rotation = Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()) * part.rotation;
  const CoarseSearch search(sought.outline, sought.evidence, sought.lens, {});
  const std::vector<OutlinePose> starts = search.starts_about({part}, 10);
  EXPECT_GT(starts.size(), 30U);
  EXPECT_LE(starts.size(), 60U);
  EXPECT_TRUE(std::any_of(starts.begin(), starts.end(), [&](const OutlinePose& start) {
    return angle_between(start.rotation, sought.pose.rotation) * degrees < 15 &&
           std::abs(std::log(start.scale / sought.pose.scale)) < 0.15 &&
           (start.shift - sought.pose.shift).norm() < 0.15 * sought.pose.scale;
  }));
}

// Starting poses are as far apart as they are said to be.
TEST(CoarseSearch, StartsAreDistinct) {
  const Sought sought;
  const CoarseSearch search(sought.outline, sought.evidence, sought.lens, {});
  const std::vector<OutlinePose> starts = search.starts(0, 60);
  ASSERT_GT(starts.size(), 20U);
  for (std::size_t i = 0; i < starts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double larger = std::max(starts[i].scale, starts[j].scale);
      EXPECT_TRUE(angle_between(starts[i].rotation, starts[j].rotation) * degrees > 9.99 ||
                  (starts[i].shift - starts[j].shift).norm() > 0.19 * larger / 1.25 ||
                  std::abs(std::log(starts[i].scale / starts[j].scale)) > 0.19)
          << i << " " << j;
    }
}

double score_of(const Sought& sought, const OutlinePose& pose) {
  OutlineDrawing drawing;
  const int level = 1;
  drawing.draw(sought.outline, pose, sought.evidence.window(level));
  std::vector<RimResidual> residuals;
  return sought.evidence.match(drawing, level, 3, 2, residuals).score();
}

TEST(ColorEvidence, CountsWhatThePhotoCutsOffAgainstAPose) {
  const Sought whole;
  const Sought cut(170);  // its middle is at the right border
  ASSERT_GT(score_of(whole, whole.pose), 0.8);
  EXPECT_LT(score_of(cut, cut.pose), 0.85 * score_of(whole, whole.pose));
  EXPECT_GT(score_of(cut, cut.pose), 0.3);
}

// Half a pixel beside the edges a refined pose loses little, ten pixels beside them nearly all.
TEST(ColorEvidence, RanksByTheOutlineAllRound) {
  const Sought sought;
  const double right = score_of(sought, sought.pose);
  OutlinePose beside = sought.pose;
  beside.shift.x() += 0.5;
  EXPECT_GT(score_of(sought, beside), 0.9 * right);
  beside.shift.x() += 9.5;
  EXPECT_LT(score_of(sought, beside), 0.35 * right);
}

// What light explains is compared where the same pixels are seen, and nowhere else.
TEST(RankByAppearance, ComparesPosesInOnePlace) {
  const auto scored = [](double x, double score) {
    RefinedPose pose;
    pose.pose.scale = 50;
    pose.pose.shift.x() = x;
    pose.agreement.ranking = score;
    return pose;
  };
  std::vector<RefinedPose> poses = {scored(0, 0.6), scored(5, 0.62), scored(300, 0.5)};
  const auto explained = [](const OutlinePose& pose) {
    if (pose.shift.x() > 100) return 0.9;
    return pose.shift.x() > 2 ? 0.2 : 0.5;
  };
  rank_by_appearance(poses, explained);
  EXPECT_EQ(poses[0].pose.shift.x(), 0);
  EXPECT_DOUBLE_EQ(poses[0].agreement.score(), 0.6);
  EXPECT_EQ(poses[1].pose.shift.x(), 300);
  EXPECT_DOUBLE_EQ(poses[1].agreement.score(), 0.5);
  EXPECT_NEAR(poses[2].agreement.score(), 0.62 * std::sqrt(0.5 / 0.8), 1e-12);
  EXPECT_DOUBLE_EQ(poses[2].agreement.lit, 0.2);
}

}  // namespace
}  // namespace drape::alignment
