#include <gtest/gtest.h>

#include "drape/registration/register_scans.hpp"
#include "shapes.hpp"

namespace drape::registration {
namespace {

const std::vector<std::optional<Rigid3>> two_at_home{Rigid3::Identity(), Rigid3::Identity()};

RangeScan plate(double z, std::uint64_t seed) {
  return test::scan_field([box = test::box_field({20, 20, 1}),
                           z](const Eigen::Vector3d& p) { return box(p - Eigen::Vector3d(0, 0, z)); },
                          Rigid3::Identity(), {.seed = seed});
}

TEST(MergedCloud, HoldsEveryPlacedPointInTheWorld) {
  test::ScannedShape shape = test::scan_from_sides(test::balls_field(), 0);
  const Registration found = register_scans(shape.scans, shape.given(), {.method = Method::given}, {});
  std::size_t points = 0;
  for (const RangeScan& scan : shape.scans) points += scan.cloud.size();
  ASSERT_EQ(found.merged.size(), points);
  ASSERT_EQ(found.merged.normals.size(), points);
  ASSERT_EQ(found.merged.confidences.size(), points);
  const auto field = test::balls_field();
  std::size_t outward = 0;
  for (std::size_t i = 0; i < points; ++i) {
    EXPECT_NEAR(field(found.merged.positions[i]), 0, 1e-8);
    outward += field(found.merged.positions[i] + 0.5 * found.merged.normals[i].cast<double>()) > 0 ? 1 : 0;
  }
  EXPECT_GT(outward, points * 99 / 100) << "but where two balls meet";
}

TEST(MergedCloud, KeepsColoursAndIntensitiesThatAllScansHave) {
  std::vector<RangeScan> scans{plate(0, 1), plate(50, 2)};
  for (RangeScan& scan : scans) {
    for (const auto& p : scan.cloud.positions) scan.cloud.intensities.push_back(static_cast<float>(p.x()));
    scan.cloud.confidences.assign(scan.cloud.size(), 0.25F);
  }
  scans[0].cloud.colors.assign(scans[0].cloud.size(), Eigen::Vector3f(1, 0, 0));
  const PointCloud merged = register_scans(scans, two_at_home, {}, {}).merged;
  EXPECT_TRUE(merged.colors.empty());
  ASSERT_EQ(merged.intensities.size(), merged.size());
  for (std::size_t i = 0; i < merged.size(); ++i) {
    EXPECT_EQ(merged.intensities[i], static_cast<float>(merged.positions[i].x()));
    EXPECT_EQ(merged.confidences[i], 0.25F);
  }
  scans[1].cloud.colors.assign(scans[1].cloud.size(), Eigen::Vector3f(0, 1, 0));
  const PointCloud colored = register_scans(scans, two_at_home, {}, {}).merged;
  ASSERT_EQ(colored.colors.size(), colored.size());
  EXPECT_EQ(colored.colors.front(), Eigen::Vector3f(1, 0, 0));
  EXPECT_EQ(colored.colors.back(), Eigen::Vector3f(0, 1, 0));
}

TEST(MergedCloud, IsThinnedToOnePointACube) {
  const std::vector<RangeScan> scans{plate(0, 1)};
  const std::vector<std::optional<Rigid3>> home{Rigid3::Identity()};
  const PointCloud all = register_scans(scans, home, {}, {}).merged;
  EXPECT_EQ(all.size(), 1600U);
  const PointCloud thin = register_scans(scans, home, {.thin_spacings = 4}, {}).merged;
  EXPECT_EQ(thin.size(), 100U);
  for (std::size_t i = 0; i < thin.size(); ++i) {
    EXPECT_NEAR(thin.positions[i].z(), 1, 1e-9);
    EXPECT_NEAR(thin.normals[i].z(), 1, 1e-6);
  }
}

TEST(MergedCloud, ThinningWeighsByConfidence) {
  std::vector<RangeScan> scans{plate(0, 1), plate(0.4, 2)};
  scans[0].cloud.confidences.assign(scans[0].cloud.size(), 0.9F);
  scans[1].cloud.confidences.assign(scans[1].cloud.size(), 0.1F);
  const PointCloud thin =
      register_scans(scans, two_at_home, {.method = Method::given, .thin_spacings = 8}, {}).merged;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    EXPECT_NEAR(thin.positions[i].z(), 1 + 0.1 * 0.4, 1e-6);
    EXPECT_EQ(thin.confidences[i], 0.9F);
  }
}

TEST(MergedCloud, ThinningKeepsBothSidesOfASheet) {
  const auto sheet = test::box_field({20, 20, 0.3});
  const Rigid3 from_below = test::rotation_deg(180, Eigen::Vector3d::UnitX());
  const std::vector<RangeScan> scans{test::scan_field(sheet, Rigid3::Identity(), {}),
                                     test::scan_field(sheet, from_below, {})};
  const PointCloud thin =
      register_scans(scans, std::vector<std::optional<Rigid3>>{Rigid3::Identity(), from_below},
                     {.thin_spacings = 4}, {})
          .merged;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    EXPECT_NEAR(std::abs(thin.positions[i].z()), 0.3, 1e-6);
    EXPECT_NEAR(thin.normals[i].z() * thin.positions[i].z(), 0.3, 1e-5);
  }
  EXPECT_GE(thin.size(), 200U);
}

}  // namespace
}  // namespace drape::registration
