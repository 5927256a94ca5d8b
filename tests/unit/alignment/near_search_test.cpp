// Poses beside the one that a refinement stopped at.
#include "near_search.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "bodies.hpp"
#include "distinct_poses.hpp"
#include "photo_plane.hpp"
#include "stencil_evidence.hpp"

namespace drape::alignment {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

class NearSearch : public ::testing::Test {
 protected:
  NearSearch() : evidence_(photo_, PhotoPlane(640, 480, std::nullopt)) {
    lens_.photo_width_px = 640;
    truth_ = *pose_of(camera_, sphere_, {320, 240});
  }

  [[nodiscard]] OutlinePose off_by(double deg, int axis, double perspective) const {
    OutlinePose pose = truth_;
    pose.rotation =
        Eigen::AngleAxisd(deg / degrees, Eigen::Vector3d::Unit(axis)).toRotationMatrix() * pose.rotation;
    pose.perspective = perspective;
    return pose;
  }
  [[nodiscard]] double error_deg(const RefinedPose& refined) const {
    return angle_between(refined.pose.rotation, truth_.rotation) * degrees;
  }

  TriangleMesh mesh_ = knobbed_brick();
  Camera camera_ = view_of({290, 110, 250}).resized(640, 480);
  Image8 photo_ = stencil_of(mesh_, camera_);
  UnitSphere sphere_ = unit_sphere(mesh_);
  OutlineMesh outline_ = outline_mesh(mesh_, sphere_);
  MeshLevels meshes_{outline_, outline_, outline_};
  StencilEvidence evidence_;
  LensPrior lens_;
  OutlinePose truth_;
};

TEST_F(NearSearch, FindsWhatARefinementDoesNot) {
  OutlineDrawing drawing;
  const RefinementPlan fine{evidence_.levels() - 1, 8, 5, 1.5, 1.0, false};
  int lost = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double deg : {-9.0, 9.0}) {
      const OutlinePose about = off_by(deg, axis, 0.4 * truth_.perspective);
      lost += error_deg(refine_pose(outline_, about, evidence_, lens_, fine, drawing)) > 1 ? 1 : 0;
      const std::vector<RefinedPose> found = search_near(about, meshes_, evidence_, lens_, {});
      ASSERT_FALSE(found.empty());
      EXPECT_LT(error_deg(found.front()), 0.3) << axis << ' ' << deg;
    }
  EXPECT_GT(lost, 2);
}

TEST_F(NearSearch, KeepsALensThatIsFixed) {
  lens_.fixed_focal_px = truth_.scale / truth_.perspective;
  for (const RefinedPose& found :
       search_near(off_by(4, 1, truth_.perspective), meshes_, evidence_, lens_, {}))
    EXPECT_NEAR(found.pose.scale / found.pose.perspective, *lens_.fixed_focal_px, 1e-6);
}

TEST_F(NearSearch, OverlapTellsHowFarOutlinesAreApart) {
  Image8 disc(200, 200, 1, stencil::background);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      if (std::hypot(x + 0.5 - 100, y + 0.5 - 100) < 60) disc.at(x, y) = stencil::object;
  const StencilEvidence evidence(disc, PhotoPlane(200, 200, std::nullopt));
  EXPECT_EQ(evidence.mean_distance_px(1), 0);
  EXPECT_NEAR(evidence.mean_distance_px(60.0 * 60 / (61 * 61)), 1, 0.05);  // a pixel more all round
}

TEST_F(NearSearch, DistinctPosesAreFartherApart) {
  RefinedPose good;
  good.pose = truth_;
  good.agreement.fit = 0.9;
  RefinedPose alike = good;
  alike.pose = off_by(2, 0, truth_.perspective);
  alike.agreement.fit = 0.8;
  RefinedPose other = good;
  other.pose = off_by(20, 0, truth_.perspective);
  other.agreement.fit = 0.7;
  const std::vector<RefinedPose> distinct = distinct_poses({other, alike, good}, 5);
  ASSERT_EQ(distinct.size(), 2U);
  EXPECT_EQ(distinct[0].pose.rotation, truth_.rotation);
  EXPECT_EQ(distinct[1].pose.rotation, other.pose.rotation);
  EXPECT_EQ(distinct_poses({other, alike, good}, 1).size(), 1U);
}

}  // namespace
}  // namespace drape::alignment
