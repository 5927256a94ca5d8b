#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "drape/base/files.hpp"
#include "drape/base/random.hpp"
#include "drape/io/scan_files.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::ScratchFolder;

/// Same bits, so that -0 and denormals count.
template <class Value>
bool same_bits(const std::vector<Value>& a, const std::vector<Value>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0);
}

void expect_same(const PointCloud& a, const PointCloud& b) {
  EXPECT_TRUE(same_bits(a.positions, b.positions));
  EXPECT_TRUE(same_bits(a.normals, b.normals));
  EXPECT_TRUE(same_bits(a.colors, b.colors));
  EXPECT_TRUE(same_bits(a.intensities, b.intensities));
  EXPECT_TRUE(same_bits(a.confidences, b.confidences));
}

/// A scan with random values in every attribute that `attributes` has a bit for.
RangeScan random_scan(std::uint64_t seed, unsigned attributes) {
  Rng rng(seed);
  RangeScan scan;
  scan.file = " odd % name\n.ply ";
  scan.index_in_file = 3;
  scan.spacing = rng.uniform() * 1e-3;
  const auto points = static_cast<std::size_t>(1 + rng.below(40));
  const auto value = [&] { return rng.normal() * std::pow(10.0, rng.uniform(-300, 300)); };
  const auto small = [&] { return static_cast<float>(rng.uniform()); };
  for (std::size_t i = 0; i < points; ++i) {
    scan.cloud.positions.emplace_back(value(), value(), -0.0);
    if (attributes & 1) scan.cloud.normals.emplace_back(small(), small(), -small());
    if (attributes & 2) scan.cloud.colors.emplace_back(small(), small(), small());
    if (attributes & 4)
      scan.cloud.colors.emplace_back(static_cast<float>(rng.below(256)) / 255.0F, 0.0F, 1.0F);
    if (attributes & 8) scan.cloud.intensities.push_back(small());
    if (attributes & 16) scan.cloud.confidences.push_back(small());
  }
  if ((attributes & 6) == 6) scan.cloud.colors.resize(points);
  if (attributes & 32) {
    scan.grid = RangeGrid{7, 5, std::vector<std::int32_t>(35, RangeGrid::missing)};
    for (std::int32_t& cell : scan.grid->cells)
      if (rng.uniform() < 0.7) cell = static_cast<std::int32_t>(rng.below(points));
  }
  if (attributes & 64) {
    scan.view = {ScanView::Kind::origin, {value(), value(), value()}};
    scan.world_from_scan =
        Rigid3(Eigen::AngleAxisd(rng.uniform(0, 3), Eigen::Vector3d(1, 2, 3).normalized()));
    scan.world_from_scan->translation() = Eigen::Vector3d(rng.normal(), 1e300, -0.0);
  } else {
    scan.view = {ScanView::Kind::direction, Eigen::Vector3d(0.6, rng.uniform() * 1e-9, -0.8)};
  }
  return scan;
}

TEST(ScanPly, WhatIsWrittenReadsBackToTheSameBits) {
  const ScratchFolder folder;
  for (unsigned attributes = 0; attributes < 128; ++attributes) {
    const RangeScan scan = random_scan(attributes, attributes);
    write_file(folder / "before.txt", "");
    io::write_scan_ply(folder / "scan.ply", scan);
    const RangeScan back = io::read_scan_ply(folder / "scan.ply");
    expect_same(scan.cloud, back.cloud);
    EXPECT_EQ(back.file, scan.file);
    EXPECT_EQ(back.index_in_file, scan.index_in_file);
    EXPECT_EQ(back.spacing, scan.spacing);
    EXPECT_EQ(back.view.kind, scan.view.kind);
    EXPECT_EQ(back.view.vector, scan.view.vector);
    ASSERT_EQ(back.grid.has_value(), scan.grid.has_value());
    if (scan.grid) {
      EXPECT_EQ(back.grid->rows, 7);
      EXPECT_EQ(back.grid->columns, 5);
      EXPECT_EQ(back.grid->cells, scan.grid->cells);
    }
    ASSERT_EQ(back.world_from_scan.has_value(), scan.world_from_scan.has_value());
    if (scan.world_from_scan) {
      EXPECT_EQ(back.world_from_scan->matrix(), scan.world_from_scan->matrix());
    }
    // The reader for users' files sees the same, but knows the file by the name that it has now.
    const std::vector<RangeScan> all = io::read_scans(folder / "scan.ply");
    ASSERT_EQ(all.size(), 1U);
    expect_same(scan.cloud, all[0].cloud);
    EXPECT_EQ(all[0].file, "scan.ply");
    EXPECT_EQ(all[0].index_in_file, 0);
    if (HasFailure()) FAIL() << "with attributes " << attributes;
  }
}

TEST(ScanPly, CloudsReadBackToTheSameBits) {
  const ScratchFolder folder;
  const PointCloud cloud = random_scan(5, 1 + 2 + 8 + 16).cloud;
  io::write_cloud_ply(folder / "cloud.ply", cloud);
  expect_same(cloud, io::read_cloud_ply(folder / "cloud.ply"));
  io::write_cloud_ply(folder / "none.ply", {});
  EXPECT_TRUE(io::read_cloud_ply(folder / "none.ply").empty());
}

TEST(ScanPly, BunnyScansKeepTheirLattice) {
  if (!test::have_data("scans/bunny")) GTEST_SKIP() << "needs scans/bunny of DRAPE_TEST_DATA";
  const RangeScan scan = io::read_scans(test::data("scans/bunny/bun000.ply")).at(0);
  EXPECT_EQ(scan.file, "bun000.ply");
  EXPECT_EQ(scan.cloud.size(), 40256U);
  EXPECT_TRUE(scan.cloud.normals.empty());
  EXPECT_EQ(scan.cloud.positions[0], Eigen::Vector3d(-0.06325, 0.0359793, 0.0420873));
  ASSERT_TRUE(scan.grid);
  EXPECT_EQ(scan.grid->rows, 400);
  EXPECT_EQ(scan.grid->columns, 512);
  std::size_t filled = 0;
  for (const std::int32_t cell : scan.grid->cells) filled += cell != RangeGrid::missing ? 1 : 0;
  EXPECT_EQ(filled, 40256U);
  EXPECT_EQ(scan.view.kind, ScanView::Kind::direction);
}

TEST(ScanPly, WriteErrorsAreIoErrors) {
  const ScratchFolder folder;
  const RangeScan scan = random_scan(1, 0);
  EXPECT_NE(error_message(ErrorCode::io, [&] { io::write_scan_ply(folder / "none/scan.ply", scan); })
                .find("scan.ply"),
            std::string::npos);
  if (std::filesystem::exists("/dev/full")) {
    std::filesystem::create_symlink("/dev/full", folder / "full.ply.writing");
    EXPECT_FALSE(
        error_message(ErrorCode::io, [&] { io::write_scan_ply(folder / "full.ply", scan); }).empty());
    EXPECT_FALSE(std::filesystem::exists(folder / "full.ply"));
  }
}

}  // namespace
}  // namespace drape
