// Photos of one block: cameras known among themselves, brought to the mesh together.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "block_pose.hpp"
#include "bodies.hpp"
#include "drape/alignment/align_block.hpp"
#include "drape/base/parallel.hpp"
#include "support.hpp"

namespace drape::alignment {
namespace {

using Eigen::Vector3d;

Similarity some_similarity() {
  return {7.5, Eigen::AngleAxisd(2.1, Vector3d(1, -2, 0.5).normalized()).toRotationMatrix(), {30, -4, 12}};
}

// The camera as the block's program would know it.
Rigid3 in_block(const Camera& camera, const Similarity& s) {
  Rigid3 result = Rigid3::Identity();
  result.linear() = camera.camera_from_world.linear() * s.rotation.transpose();
  result.translation() = s.scale * camera.camera_from_world.translation() - result.linear() * s.translation;
  return result;
}

/// Photos of a mesh with their truth; stencils must outlive what refers to them.
struct Photos {
  std::vector<Camera> cameras;
  std::vector<Image8> stencils;

  Photos(const TriangleMesh& mesh, const std::vector<Camera>& seen_by) : cameras(seen_by) {
    for (const Camera& camera : cameras) stencils.push_back(stencil_of(mesh, camera));
  }
  [[nodiscard]] std::vector<BlockPhoto> block() const {
    std::vector<BlockPhoto> photos;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      PhotoEvidence evidence{stencils[i]};
      evidence.lens = KnownLens{cameras[i].K, {}};
      photos.push_back({evidence, in_block(cameras[i], some_similarity())});
    }
    return photos;
  }
};

std::vector<Camera> three_views(double fov_deg = 45) {
  std::vector<Camera> cameras;
  for (const Vector3d& angles : {Vector3d(20, 70, 130), Vector3d(290, 110, 250), Vector3d(200, 30, 10)})
    cameras.push_back(
        view_of(angles, 34, 85, 57, Camera::Projection::perspective, fov_deg).resized(640, 480));
  return cameras;
}

TEST(BlockPose, TheSimilarityOfTwoPosesComesBack) {
  const std::vector<Camera> cameras = three_views();
  const Similarity truth = some_similarity();
  const auto opinion = pair_opinion(in_block(cameras[0], truth), cameras[0].camera_from_world,
                                    in_block(cameras[1], truth), cameras[1].camera_from_world);
  ASSERT_TRUE(opinion);
  EXPECT_LT(opinion->disagreement_rad, 1e-7);
  EXPECT_NEAR(opinion->block_from_world.scale, truth.scale, 1e-9);
  EXPECT_LT((opinion->block_from_world.rotation - truth.rotation).norm(), 1e-9);
  EXPECT_LT((opinion->block_from_world.translation - truth.translation).norm(), 1e-8);
  const Rigid3 pose = camera_from_world(in_block(cameras[2], truth), truth);
  EXPECT_LT((pose.matrix() - cameras[2].camera_from_world.matrix()).norm(), 1e-9);
}

TEST(BlockPose, ContradictingScalesAreNoOpinion) {
  const std::vector<Camera> cameras = three_views();
  Similarity mirrored = some_similarity();
  mirrored.scale *= -1;
  EXPECT_FALSE(pair_opinion(in_block(cameras[0], mirrored), cameras[0].camera_from_world,
                            in_block(cameras[1], mirrored), cameras[1].camera_from_world));
}

TEST(Block, AllPhotosTogetherGiveTheSimilarity) {
  const TriangleMesh mesh = knobbed_brick();
  const Photos photos(mesh, three_views());
  const BlockAlignment found = align_block(mesh, photos.block(), {}, 1, {});
  ASSERT_TRUE(found.block_from_world);
  const Similarity truth = some_similarity();
  EXPECT_EQ(found.verdict, Verdict::accept) << found.reasons.front();
  const Eigen::Quaterniond turn(found.block_from_world->rotation * truth.rotation.transpose());
  EXPECT_LT(turn.angularDistance(Eigen::Quaterniond::Identity()) * 180 / std::numbers::pi, 0.1);
  EXPECT_NEAR(found.block_from_world->scale / truth.scale, 1, 0.003);
  ASSERT_EQ(found.photos.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.photos[i].verdict, Verdict::accept);
    EXPECT_GT(found.photos[i].overlap_percent, 99.5);
    EXPECT_LT(rotation_between_deg(found.photos[i].camera, photos.cameras[i]), 0.1);
    EXPECT_LT((found.photos[i].camera.K - photos.cameras[i].K).norm(), 1e-9) << "the lens is kept";
  }
}

TEST(Block, RoughOutlinesAreJudgedByTheirNoise) {
  const TriangleMesh mesh = knobbed_brick();
  Photos photos(mesh, three_views());
  for (Image8& stencil : photos.stencils) stencil = wavy(stencil, 5);
  const BlockAlignment found = align_block(mesh, photos.block(), {}, 1, {});
  EXPECT_EQ(found.verdict, Verdict::accept) << found.reasons.front();
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT(rotation_between_deg(found.photos[i].camera, photos.cameras[i]), 2);
    EXPECT_GT(found.photos[i].outline.value().noise_px, 0.5);
  }
}

TEST(Block, TheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = knobbed_brick();
  const Photos photos(mesh, three_views());
  set_thread_count(1);
  const BlockAlignment one = align_block(mesh, photos.block(), {}, 1, {});
  set_thread_count(3);
  const BlockAlignment three = align_block(mesh, photos.block(), {}, 1, {});
  set_thread_count(0);
  ASSERT_TRUE(one.block_from_world && three.block_from_world);
  EXPECT_EQ(one.block_from_world->translation, three.block_from_world->translation);
  EXPECT_EQ(one.photos[1].camera.P(), three.photos[1].camera.P());
}

// A long lens, and a body whose left and right are alike: each photo by itself has a twin.
TEST(Block, WhatOnePhotoLeavesOpenTheOthersDecide) {
  TriangleMesh mesh = test::box({-1, -0.6, -0.4}, {1, 0.6, 0.4});
  const TriangleMesh nose = test::box({0.99, -0.2, -0.4}, {1.6, 0.2, 0.1});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), nose.vertices.begin(), nose.vertices.end());
  for (const auto& face : nose.faces)
    mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
  const Photos photos(mesh, three_views(3));
  int open = 0;
  for (const BlockPhoto& photo : photos.block())
    open += align_photo(mesh, photo.evidence, {}, 1, {}).verdict != Verdict::accept;
  EXPECT_GT(open, 0) << "else the photos are too easy";
  const BlockAlignment found = align_block(mesh, photos.block(), {}, 1, {});
  EXPECT_EQ(found.verdict, Verdict::accept) << found.reasons.front();
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(rotation_between_deg(found.photos[i].camera, photos.cameras[i]), 0.3);
}

TEST(Block, AnotherObjectIsNotAccepted) {
  const Photos photos(knobbed_brick(), three_views());
  const BlockAlignment found = align_block(test::torus(1, 0.3), photos.block(), {}, 1, {});
  EXPECT_NE(found.verdict, Verdict::accept);
  EXPECT_FALSE(found.reasons.empty());
  EXPECT_EQ(found.photos.size(), 3U);
}

TEST(Block, SaysWhatIsMissing) {
  const TriangleMesh mesh = knobbed_brick();
  const Photos photos(mesh, three_views());
  const auto message = [&](const std::vector<BlockPhoto>& block) {
    return test::error_message(ErrorCode::config, [&] { (void)align_block(mesh, block, {}, 1, {}); });
  };
  EXPECT_NE(message({photos.block()[0]}).find("two photos"), std::string::npos);
  auto block = photos.block();
  block[1].evidence.lens.reset();
  EXPECT_NE(message(block).find("no lens"), std::string::npos);
  block = photos.block();
  for (BlockPhoto& photo : block) photo.camera_from_block = block[0].camera_from_block;
  EXPECT_NE(message(block).find("one place"), std::string::npos);
}

}  // namespace
}  // namespace drape::alignment
