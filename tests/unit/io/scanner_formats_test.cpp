// What scanners write: PTX, PTS, LAS, E57, 3DTK, depth pictures, meshes as scans; made here and as found in
// the wild.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/scan_files.hpp"
#include "picture_bytes.hpp"
#include "scan_bytes.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::raw;
using test::ScratchFolder;

std::vector<RangeScan> scans_of(const std::string& name, const std::string& bytes,
                                const io::ScanReadOptions& o = {}) {
  return io::parse_scans(name, bytes, o);
}

void expect_problem(const std::string& name, const std::string& bytes, const std::string& what) {
  const std::string message = error_message(ErrorCode::input, [&] { (void)scans_of(name, bytes); });
  EXPECT_NE(message.find(what), std::string::npos) << message;
}

void expect_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double tolerance = 1e-12) {
  EXPECT_LT((a - b).norm(), tolerance) << a.transpose() << " and " << b.transpose();
}

const std::string identity_header = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

TEST(Ptx, GridGoesColumnByColumnAndMissingCellsAreGaps) {
  const auto scans =
      scans_of("a.ptx", "2\n3\n" + identity_header +
                            "0 0 0 0.5\n1 2 3 0.25\n4 5 6 1\n7 8 9 0\n0 0 0 0.5\n10 11 12 0.5\n");
  ASSERT_EQ(scans.size(), 1U);
  const RangeScan& scan = scans[0];
  ASSERT_TRUE(scan.grid);
  EXPECT_EQ(scan.grid->rows, 3);
  EXPECT_EQ(scan.grid->columns, 2);
  EXPECT_EQ(scan.grid->cells, (std::vector<std::int32_t>{-1, 2, 0, -1, 1, 3}));
  expect_near(scan.cloud.positions[2], {7, 8, 9});
  EXPECT_EQ(scan.cloud.intensities, (std::vector<float>{0.25F, 1, 0, 0.5F}));
}

TEST(Ptx, TranslationIsTheLastRowAndTheScannerSeesFromIts0) {
  // A quarter turn about z, then (600000, 100, 5): x_world = (600000 - y, 100 + x, 5 + z).
  const std::string header =
      "600000.125 100 5\n0 1 0\n-1 0 0\n0 0 1\n0 1 0 0\n-1 0 0 0\n0 0 1 0\n600000.125 100 5 1\n";
  const RangeScan scan = scans_of("a.ptx", "1\n1\n" + header + "1 2 3 0.5 255 0 51\r\n").at(0);
  ASSERT_TRUE(scan.world_from_scan);
  const Eigen::Vector3d x_in_world = *scan.world_from_scan * scan.cloud.positions[0];
  expect_near(x_in_world, {600000.125 - 2, 101, 8}, 1e-9);
  EXPECT_EQ(scan.view.kind, ScanView::Kind::origin);
  expect_near(scan.view.vector, {0, 0, 0}, 1e-9);
  EXPECT_EQ(scan.cloud.colors[0], Eigen::Vector3f(1, 0, 0.2F));
}

TEST(Ptx, SaysWhereMatrixAndScannerDiffer) {
  const log::WarningCapture capture;
  (void)scans_of("a.ptx", "1\n1\n7 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3\n");
  ASSERT_EQ(capture.warnings().size(), 1U);
  EXPECT_NE(capture.warnings()[0].find("differ by 7 units"), std::string::npos) << capture.warnings()[0];
}

TEST(Ptx, RefusesWhatMakesNoSense) {
  expect_problem("a.ptx", "2\n3\n" + identity_header + "1 2 3\n", "a.ptx:10: the scan claims 2 x 3 points");
  expect_problem("a.ptx", "-2\n3\n", "a.ptx:1: \"-2\" is no number of columns or rows");
  expect_problem("a.ptx", "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\nx 1 0 0\n", "a.ptx:8: ");
  expect_problem("a.ptx", "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0 0\n0 0 0 0\n0 0 0 0\n0 0 0 1\n1 2 3\n",
                 "a.ptx:10: the scan's matrix has no inverse");
  expect_problem("a.ptx", "1\n2\n" + identity_header + "1 2 3 4\n1 2 3 4 5 6 7\n", "a.ptx:12: has 7 numbers");
  expect_problem("a.ptx", "1\n1\n" + identity_header + "1 2 3 4 5\n", "a.ptx:11: has 5 numbers");
  expect_problem("a.ptx", "1\n1\n" + identity_header + "0 0 0 0.5\n", "holds no point");
}

TEST(Pts, SeveralCountsAreSeveralScans) {
  const auto scans = scans_of("a.pts", "2\n1 2 3 -2048 255 0 0\n4 5 6 2047 0 255 0\n1\n7 8 9 0 0 0 255\n");
  ASSERT_EQ(scans.size(), 2U);
  EXPECT_EQ(scans[0].cloud.size(), 2U);
  EXPECT_EQ(scans[0].cloud.intensities, (std::vector<float>{0, 1}));
  EXPECT_EQ(scans[1].cloud.colors.at(0), Eigen::Vector3f(0, 0, 1));
}

TEST(Text, StatedColumnsCountMoreThanTheGuess) {
  io::ScanReadOptions options;
  options.columns = {"z", "-", "x", "y", "intensity"};
  const RangeScan scan = scans_of("a.txt", "1 2 3 4 0.5\n5 6 7 8 1\n", options).at(0);
  expect_near(scan.cloud.positions[1], {7, 8, 5});
  EXPECT_EQ(scan.cloud.intensities, (std::vector<float>{0.5F, 1}));
  options.columns = {"x", "y"};
  EXPECT_NE(error_message(ErrorCode::input, [&] { (void)scans_of("a.txt", "1 2 3\n", options); })
                .find("a.txt:1: has 3 columns, but input.columns names 2"),
            std::string::npos);
}

TEST(Las, EveryPointFormatKeepsPlaceColourAndIntensity) {
  for (int format = 0; format <= 10; ++format) {
    const int minor = format < 2 ? 0 : format < 4 ? 2 : format < 6 ? 3 : 4;
    const RangeScan scan = scans_of("a.las", test::las_bytes(minor, format)).at(0);
    ASSERT_EQ(scan.cloud.size(), 3U) << format;
    // 123456789 steps of 0.01 from 500000: no float holds it.
    expect_near(scan.cloud.positions[1], {500000 + 1234567.89, -2000, 30}, 1e-9);
    EXPECT_EQ(scan.cloud.intensities, (std::vector<float>{0, 0.4F, 1})) << format;
    const bool colored =
        format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
    ASSERT_EQ(scan.cloud.colors.size(), colored ? 3U : 0U) << format;
    if (colored) {
      EXPECT_EQ(scan.cloud.colors[2], Eigen::Vector3f(1, 0, 0.2F));
    }
  }
}

TEST(Las, RefusesWhatMakesNoSense) {
  const std::string good = test::las_bytes(2, 2);
  const auto with = [&](std::size_t at, const std::string& bytes) {
    std::string changed = good;
    changed.replace(at, bytes.size(), bytes);
    return changed;
  };
  expect_problem("a.las", with(107, raw(4U, false)), "byte 107: the header claims 4 points of 29 bytes");
  expect_problem("a.las", with(104, "\x82"), "compressed (LAZ); decompress the file first: laszip");
  expect_problem("a.las", with(104, "\x0B"), "byte 104: point format 11 is not known");
  expect_problem("a.las", with(105, std::string("\x05\0", 2)), "byte 105: points of format 2 take 26 bytes");
  expect_problem("a.las", with(131, raw(0.0, false)), "byte 131: ");
  expect_problem("a.las", with(96, raw(10U, false)), "byte 96: ");
  expect_problem("a.las", with(24, "\x02"), "byte 24: ");
}

TEST(E57, WrittenFieldsComeBack) {
  test::E57Maker maker;
  maker.scans.push_back(test::e57_scan_of_all_kinds());
  const auto scans = scans_of("a.e57", maker.bytes());
  ASSERT_EQ(scans.size(), 1U);
  const RangeScan& scan = scans[0];
  ASSERT_EQ(scan.cloud.size(), 299U);  // one of 300 is marked as invalid
  ASSERT_TRUE(scan.grid);
  EXPECT_EQ(scan.grid->rows, 20);
  EXPECT_EQ(scan.grid->columns, 15);
  EXPECT_EQ(scan.grid->at(0, 7), RangeGrid::missing);
  for (const std::int32_t i : {0, 100, 298}) {
    const int k = i < 7 ? i : i + 1;
    const auto at = static_cast<std::size_t>(i);
    expect_near(scan.cloud.positions[at], {0.5 * k, 0.001 * (k - 150) + 4, 1e6 + k}, 1e-9);
    EXPECT_EQ(scan.grid->at(k / 15, k % 15), i);
    EXPECT_NEAR(scan.cloud.intensities[at], k / 300.0, 1e-6);
    EXPECT_EQ(scan.cloud.colors[at], Eigen::Vector3f(static_cast<float>(k % 256) / 255.0F, 1, 0));
  }
  ASSERT_TRUE(scan.world_from_scan);
  expect_near(*scan.world_from_scan * Eigen::Vector3d(1, 0, 0), {10, 21, 30},
              1e-9);  // a quarter turn about z
}

TEST(E57, APhotoComesOutWithItsCamera) {
  test::E57Maker maker;
  maker.scans.push_back(test::e57_scan_of_all_kinds());
  maker.photo = test::depth_png(3, 2, {0, 0, 0, 65535, 0, 0});
  // At (10, 20, 30), turned by 90 degrees about z, as the scan.
  maker.photo_pose = maker.scans[0].xml.substr(0, maker.scans[0].xml.find("<intensityLimits"));
  const ScratchFolder folder;
  write_file(folder / "a.e57", maker.bytes());
  const auto photos = io::read_embedded_photos(folder / "a.e57");
  ASSERT_EQ(photos.size(), 1U);
  EXPECT_EQ(photos[0].pixels.at(0, 1), 255);
  const Camera& camera = photos[0].camera.value();
  EXPECT_EQ(camera.width, 3);
  EXPECT_NEAR(camera.K(0, 0), 3000, 1e-9);
  EXPECT_NEAR(camera.K(1, 1), 1500, 1e-9);
  // An E57 camera looks down its -z; its y, up in the picture, is the world's -x after the turn.
  const Camera::Projected seen = camera.project({10 - 0.001, 20, 30 - 2});
  EXPECT_NEAR(seen.depth, 2, 1e-9);
  expect_near({seen.pixel.x(), seen.pixel.y(), 0}, {1.5, 1 - 1500 * 0.0005, 0}, 1e-9);
}

TEST(E57, ADamagedPageIsNoticed) {
  test::E57Maker maker;
  maker.scans.push_back(test::e57_scan_of_all_kinds());
  std::string bytes = maker.bytes();
  bytes[1500] = static_cast<char>(bytes[1500] ^ 1);
  expect_problem("a.e57", bytes, "byte 1024: the checksum of this page of 1024 bytes is wrong");
}

TEST(E57, CountsThatLieAreRefused) {
  test::E57Maker maker;
  maker.scans.push_back(test::e57_scan_of_all_kinds());
  maker.scans[0].claimed_records = 1'000'000'000'000;
  expect_problem("a.e57", maker.bytes(), "claims 1000000000000 points");
  maker.scans[0].claimed_records = 301;
  expect_problem("a.e57", maker.bytes(), "a.e57: byte ");
}

TEST(Tdtk, TurnsToARightHandedFrame) {
  const ScratchFolder folder;
  write_file(folder / "scan000.3d", "2 x 1\n100 200 300\n1 2 3\n");
  write_file(folder / "scan000.pose", "10 20 30\n0 90 0\n");
  const RangeScan scan = io::read_scans(folder / "scan000.3d").at(0);
  ASSERT_EQ(scan.cloud.size(), 2U);
  expect_near(scan.cloud.positions[0], {300, -100, 200});
  // 3DTK: a turn by 90 degrees about y takes (1, 2, 3) to (3, 2, -1), then comes the translation.
  expect_near(*scan.world_from_scan * scan.cloud.positions[1], {30 - 1, -(10 + 3), 20 + 2}, 1e-9);
  write_file(folder / "scan000.frames",
             "1 0 0 0 0 1 0 0 0 0 1 0 9 9 9 1 2\n1 0 0 0 0 1 0 0 0 0 1 0 1 2 3 1 2\n");
  expect_near(io::read_scans(folder / "scan000.3d").at(0).world_from_scan->translation(), {3, -1, 2});
}

TEST(DepthPicture, PointsLieOnTheirRays) {
  const std::string png = test::depth_png(3, 2, {1000, 0, 2000, 3000, 4000, 5000});
  io::ScanReadOptions options;
  options.depth = io::DepthCamera{{2, 4}, Eigen::Vector2d(1.5, 1), 1000, false};
  const RangeScan z = scans_of("a.png", png, options).at(0);
  ASSERT_EQ(z.cloud.size(), 5U);
  EXPECT_EQ(z.grid->cells, (std::vector<std::int32_t>{0, -1, 1, 2, 3, 4}));
  expect_near(z.cloud.positions[0], {(0.5 - 1.5) / 2, (0.5 - 1) / 4, 1});
  expect_near(z.cloud.positions[3], {0, 4 * 0.5 / 4, 4});
  options.depth->along_ray = true;
  EXPECT_NEAR(scans_of("a.png", png, options).at(0).cloud.positions[4].norm(), 5, 1e-12);
  expect_problem("a.png", png, "needs input.depth");
}

TEST(DepthPicture, OpenExrGivesItsDepthChannel) {
  constexpr float infinite = std::numeric_limits<float>::infinity();
  constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values{1.5F, 0, unknown, infinite, 1e10F, 0.25F};
  io::ScanReadOptions options;
  options.depth = io::DepthCamera{{2, 4}, Eigen::Vector2d(1.5, 1), 1, false};
  for (const std::string& bytes :
       {test::depth_exr(3, 2, values, "Y"), test::depth_exr(3, 2, values, "View.Depth.Z", {"A", "R"}),
        test::depth_exr(3, 2, values, "R", {"A", "B", "G"})}) {
    const RangeScan scan = scans_of("a.exr", bytes, options).at(0);
    ASSERT_EQ(scan.cloud.size(), 2U);
    EXPECT_EQ(scan.grid->cells, (std::vector<std::int32_t>{0, -1, -1, -1, -1, 1}));
    expect_near(scan.cloud.positions[0], {-1.5 * 0.5, -1.5 * 0.125, 1.5});
    expect_near(scan.cloud.positions[1], {0.25 * 0.5, 0.25 * 0.125, 0.25});
  }
  EXPECT_NE(error_message(
                ErrorCode::input,
                [&] { (void)io::parse_scans("a.exr", test::depth_exr(3, 2, values, "x", {"A"}), options); })
                .find("none of its channels (OpenEXR: \"A\" \"x\") is depth"),
            std::string::npos);
}

TEST(MeshAsScan, GivesItsVertices) {
  const RangeScan scan = scans_of("a.obj", "v 1 2 3\nv 4 5 6\nv 7 8 10\nf 1 2 3\n").at(0);
  ASSERT_EQ(scan.cloud.size(), 3U);
  expect_near(scan.cloud.positions[2], {7, 8, 10});
}

TEST(ScanPoses, MeshLabFilesAgree) {
  const ScratchFolder folder;
  const std::string rows = "0 -1 0 5\n1 0 0 6\n0 0 1 7\n0 0 0 1\n";
  write_file(folder / "a.aln", "1\nscans/one.ply\n#\n" + rows + "0\n");
  write_file(folder / "a.mlp",
             "<!DOCTYPE MeshLabDocument>\n<MeshLabProject>\n<MeshGroup>\n<MLMesh label=\"1\" "
             "filename=\"scans\\one.ply\">\n<MLMatrix44>\n" +
                 rows + "</MLMatrix44>\n</MLMesh>\n</MeshGroup>\n</MeshLabProject>\n");
  for (const char* name : {"a.aln", "a.mlp"}) {
    const auto poses = io::read_scan_poses(folder / name);
    ASSERT_EQ(poses.size(), 1U) << name;
    expect_near(poses.at("one.ply") * Eigen::Vector3d(1, 2, 3), {3, 7, 10});
  }
  write_file(folder / "b.aln", "1\none.ply\n#\n0 -1 0 5\n1 0 0 6\n0 0 2 7\n0 0 0 1\n0\n");
  EXPECT_NE(error_message(ErrorCode::input, [&] { (void)io::read_scan_poses(folder / "b.aln"); })
                .find("b.aln:2: the matrix of \"one.ply\" is no rigid motion"),
            std::string::npos);
}

TEST(ScanWriters, WhatTheyWriteReadsBack) {
  RangeScan scan;
  scan.cloud.positions = {{500000.123456789, 1.0 / 3, -7}, {1, 2, 3}, {4, 5, 6}};
  scan.cloud.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  scan.cloud.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0.2F}};
  scan.cloud.intensities = {0, 0.25F, 1};
  scan.grid = RangeGrid{2, 2, {0, -1, 2, 1}};
  scan.view = {ScanView::Kind::origin, {0, 0, 9}};
  const ScratchFolder folder;
  for (const char* name : {"a.ply", "a.pcd", "a.xyz", "a.csv"}) {
    io::write_scan(folder / name, scan);
    const RangeScan back = io::read_scans(folder / name).at(0);
    ASSERT_EQ(back.cloud.size(), 3U) << name;
    const bool organised = std::string(name) == "a.pcd";  // its points come in the order of the cells
    for (const std::size_t i : {0U, 1U, 2U}) {
      const std::size_t from = organised && i > 0 ? 3 - i : i;
      EXPECT_EQ(back.cloud.positions[i], scan.cloud.positions[from]) << name;
      EXPECT_EQ(back.cloud.normals[i], scan.cloud.normals[from]) << name;
      EXPECT_EQ(back.cloud.colors[i], scan.cloud.colors[from]) << name;
      EXPECT_EQ(back.cloud.intensities[i], scan.cloud.intensities[from]) << name;
    }
    if (organised) {
      EXPECT_EQ(back.grid->cells, (std::vector<std::int32_t>{0, -1, 1, 2}));
      EXPECT_EQ(back.view.vector, scan.view.vector);
    }
  }
}

TEST(Thinning, KeepsTheSurfaceWhateverTheSize) {
  // 40,000 points of the unit sphere, at most 5,000 kept.
  Rng rng(3);
  RangeScan scan;
  for (int i = 0; i < 40'000; ++i) {
    const double z = rng.uniform(-1, 1), a = rng.uniform(0, 2 * std::numbers::pi);
    const double r = std::sqrt(1 - z * z);
    scan.cloud.positions.emplace_back(r * std::cos(a), r * std::sin(a), z);
  }
  const ScratchFolder folder;
  io::ScanReadOptions options;
  options.most_points = 5000;
  for (const char* name : {"a.ply", "a.xyz"}) {
    io::write_scan(folder / name, scan);
    const RangeScan thinned = io::read_scans(folder / name, options).at(0);
    EXPECT_LE(thinned.cloud.size(), 5000U) << name;
    EXPECT_GE(thinned.cloud.size(), 1250U) << name;
    // Every point has a kept one within the diagonal of a voxel; a voxel's face covers about 4 pi / kept.
    const double reach = 3 * std::sqrt(4 * std::numbers::pi / static_cast<double>(thinned.cloud.size()));
    for (std::size_t i = 0; i < scan.cloud.size(); i += 97) {
      double nearest = 9;
      for (const Eigen::Vector3d& p : thinned.cloud.positions)
        nearest = std::min(nearest, (p - scan.cloud.positions[i]).norm());
      EXPECT_LT(nearest, reach);
    }
    EXPECT_EQ(thinned.cloud.positions, io::read_scans(folder / name, options).at(0).cloud.positions);
  }
}

// --- files as found in the wild

struct Expected {
  const char* file;
  std::size_t scans, points;
};

TEST(FormatSamples, EveryLasGivesThePointsAndTheBoxOfItsHeader) {
  if (!test::have_data("scans/formats/las")) GTEST_SKIP() << "needs scans/formats/las of DRAPE_TEST_DATA";
  for (const auto& entry : std::filesystem::directory_iterator(test::data("scans/formats/las"))) {
    const std::string name = entry.path().filename().string();
    if (extension(entry.path()) == "laz") {
      EXPECT_NE(error_message(ErrorCode::input, [&] { (void)io::read_scans(entry.path()); }).find("LAZ"),
                std::string::npos);
      continue;
    }
    const std::string bytes = read_file(entry.path());
    const auto number = [&](std::size_t at) {
      double value = 0;
      std::memcpy(&value, bytes.data() + at, 8);
      return value;
    };
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 107, 4);
    std::vector<RangeScan> scans;
    ASSERT_NO_THROW(scans = io::read_scans(entry.path())) << name;
    if (count != 0) {
      EXPECT_EQ(scans[0].cloud.size(), count) << name;
    }
    const BoundingBox box = bounding_box(scans[0].cloud.positions);
    if (name == "laspy_simple1_3.las") continue;  // its header holds the box in steps, not in units
    // The header lists max x, min x, max y, ...; half a step of its scale is what rounding may do.
    for (int k = 0; k < 3; ++k) {
      const double step = number(131 + 8 * static_cast<std::size_t>(k));
      EXPECT_NEAR(box.max()[k], number(179 + 16 * static_cast<std::size_t>(k)), step) << name;
      EXPECT_NEAR(box.min()[k], number(187 + 16 * static_cast<std::size_t>(k)), step) << name;
    }
  }
}

TEST(FormatSamples, EveryPtxAndE57) {
  if (!test::have_data("scans/formats/e57")) GTEST_SKIP() << "needs scans/formats of DRAPE_TEST_DATA";
  for (const auto& [file, scan_count, points] : std::initializer_list<Expected>{
           {"ptx/1.2-with-color.ptx", 1, 1065},
           {"ptx/complex-transform.ptx", 1, 4},
           {"ptx/multiple-and-transform.ptx", 2, 8},
           {"ptx/no-color.ptx", 1, 15},
           {"e57/asm_ColouredCubeFloat.e57", 1, 7680},
           {"e57/asm_bunnyDouble.e57", 1, 30571},
           {"e57/asm_bunnyInt32.e57", 1, 30571},
           {"e57/cry_bunnyFloat.e57", 1, 30571},
           {"e57/cry_bunnyInt19.e57", 1, 30571},
           {"e57/cry_tinyCartesianFloatRgb.e57", 1, 0},
           {"e57/cry_tiny_spherical.e57", 1, 0},
           {"e57/cry_tiny_pc_and_images.e57", 1, 2},
           {"e57/pdal_A4.e57", 1, 4},
           {"e57/pdal_A_B.e57", 2, 0},
           {"e57/pye57_testWithNormals.e57", 1, 0},
       }) {
    std::vector<RangeScan> scans;
    ASSERT_NO_THROW(scans = io::read_scans(test::data("scans/formats/") / file)) << file;
    EXPECT_EQ(scans.size(), scan_count) << file;
    std::size_t sum = 0;
    for (const RangeScan& scan : scans) sum += scan.cloud.size();
    if (points != 0) {
      EXPECT_EQ(sum, points) << file;
    }
    std::cout << file << " " << sum << " points\n";
  }
}

TEST(FormatSamples, PhotosOfE57ComeOutWithTheirCameras) {
  if (!test::have_data("scans/formats/e57")) GTEST_SKIP() << "needs scans/formats/e57 of DRAPE_TEST_DATA";
  const auto photos = io::read_embedded_photos(test::data("scans/formats/e57/cry_tiny_pc_and_images.e57"));
  // A visual reference; a sphere, which no pinhole shows; and a pinhole picture whose bytes are all zero.
  ASSERT_EQ(photos.size(), 1U);
  EXPECT_EQ(photos[0].pixels.width(), 100);
  EXPECT_FALSE(photos[0].camera);
}

TEST(FormatSamples, TheBunniesOfE57AreOneBunny) {
  if (!test::have_data("scans/formats/e57")) GTEST_SKIP() << "needs scans/formats/e57 of DRAPE_TEST_DATA";
  const auto bunny = [](const char* name) {
    return io::read_scans(test::data("scans/formats/e57") / name).at(0).cloud.positions;
  };
  const auto exact = bunny("asm_bunnyDouble.e57");
  for (const auto& [name, tolerance] : std::initializer_list<std::pair<const char*, double>>{
           {"asm_bunnyInt32.e57", 1e-6}, {"cry_bunnyFloat.e57", 1e-7}, {"cry_bunnyInt19.e57", 1e-6}}) {
    const auto other = bunny(name);
    ASSERT_EQ(other.size(), exact.size());
    for (std::size_t i = 0; i < exact.size(); ++i) expect_near(other[i], exact[i], 2 * tolerance);
  }
}

}  // namespace
}  // namespace drape
