#include "drape/alignment/shared_focal.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"

namespace drape::alignment {
namespace {

Alignment photo(double focal_px, double focal_percent, int width = 640, int height = 480) {
  Alignment alignment;
  alignment.camera.width = width;
  alignment.camera.height = height;
  alignment.camera.K << focal_px, 0, 320, 0, focal_px, 240, 0, 0, 1;
  alignment.verdict = Verdict::accept;
  alignment.sigma = PoseSigma{0.1, 0.1, focal_percent};
  return alignment;
}

TEST(SharedFocal, TheSurerPhotosWeighMore) {
  const std::vector<Alignment> photos = {photo(640, 1), photo(700, 10)};
  // Weights of 100 to 1, of logarithms.
  const double expected = std::exp((100 * std::log(1.0) + std::log(700 / 640.0)) / 101);
  EXPECT_NEAR(shared_focal(photos).value(), expected, 1e-9);
}

TEST(SharedFocal, PortraitsAndOtherSizesGoTogether) {
  const std::vector<Alignment> photos = {photo(640, 1), photo(640, 1, 480, 640), photo(1280, 1, 1280, 960)};
  EXPECT_NEAR(shared_focal(photos).value(), 1, 1e-9);
}

TEST(SharedFocal, OneThatContradictsTheOthersIsLeftOut) {
  const std::vector<Alignment> photos = {photo(640, 1), photo(640, 1), photo(640, 1), photo(960, 1.2)};
  EXPECT_NEAR(shared_focal(photos).value(), 1, 1e-9);
}

TEST(SharedFocal, OnlyAcceptedPhotosThatFoundTheirOwnCount) {
  Alignment doubtful = photo(900, 1);
  doubtful.verdict = Verdict::review;
  Alignment fixed = photo(900, 0);
  EXPECT_FALSE(shared_focal(std::vector<Alignment>{photo(640, 1), doubtful, fixed}));
  EXPECT_FALSE(shared_focal(std::vector<Alignment>{}));
}

// A long lens: by itself each photo hardly knows its focal length.
TEST(SharedFocal, MakesLongLensesSurer) {
  const TriangleMesh mesh = knobbed_brick();
  const double truth = view_of({0, 0, 0}, 34, 85, 57, Camera::Projection::perspective, 12).K(0, 0) / 160;
  std::vector<Alignment> photos;
  double worst_alone = 0;
  for (const Eigen::Vector3d& angles :
       {Eigen::Vector3d(20, 70, 130), Eigen::Vector3d(290, 110, 250), Eigen::Vector3d(200, 30, 10)}) {
    const Image8 stencil =
        stencil_of(mesh, view_of(angles, 34, 85, 57, Camera::Projection::perspective, 12).resized(640, 480));
    photos.push_back(align_photo(mesh, {stencil}, {}, 1, {}));
    worst_alone = std::max(worst_alone, std::abs(photos.back().camera.K(0, 0) / 640 / truth - 1));
  }
  ASSERT_TRUE(shared_focal(photos));
  EXPECT_LT(std::abs(*shared_focal(photos) / truth - 1), std::max(0.02, 0.8 * worst_alone));
}

}  // namespace
}  // namespace drape::alignment
