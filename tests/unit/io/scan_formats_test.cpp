// PCD, points as text, Stanford poses.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/scan_files.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::ScratchFolder;

RangeScan scan_of(const std::string& name, const std::string& bytes) {
  const ScratchFolder folder;
  write_file(folder / name, bytes);
  return io::read_scans(folder / name).at(0);
}

void expect_problem(const std::string& name, const std::string& bytes, const std::string& what) {
  const std::string message = error_message(ErrorCode::input, [&] { (void)scan_of(name, bytes); });
  EXPECT_NE(message.find(name + what), std::string::npos) << message;
}

template <class Number>
std::string raw(Number value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  return {bytes.begin(), bytes.end()};
}

/// A plain LZF encoder: the longest earlier match by trying all, else a literal.
std::string lzf(const std::string& data) {
  std::string codes, literals;
  const auto flush = [&] {
    for (std::size_t at = 0; at < literals.size(); at += 32) {
      const std::string run = literals.substr(at, 32);
      codes += static_cast<char>(run.size() - 1);
      codes += run;
    }
    literals.clear();
  };
  for (std::size_t at = 0; at < data.size();) {
    std::size_t best = 0, back = 0;
    for (std::size_t b = 1; b <= std::min<std::size_t>(at, 8192); ++b) {
      std::size_t n = 0;
      while (n < 264 && at + n < data.size() && data[at + n] == data[at + n - b]) ++n;
      if (n > best) best = n, back = b;
    }
    if (best < 3) {
      literals += data[at++];
      continue;
    }
    flush();
    const std::size_t length = best - 2, distance = back - 1;
    codes += static_cast<char>(std::min<std::size_t>(length, 7) << 5 | distance >> 8);
    if (length >= 7) codes += static_cast<char>(length - 7);
    codes += static_cast<char>(distance & 255);
    at += best;
  }
  flush();
  return codes;
}

std::string pcd_header(const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y _ z rgb intensity normal_x "
         "normal_y normal_z\n"
         "SIZE 4 8 2 4 4 1 4 4 4\nTYPE F F U F F U F F F\nCOUNT 1 1 3 1 1 1 1 1 1\nWIDTH 3\nHEIGHT "
         "2\nVIEWPOINT 1 2 3 1 0 0 0\n"
         "POINTS 6\nDATA " +
         data + "\n";
}

struct PcdPoint {
  float x;
  double y;
  float z;
  std::uint32_t rgb;
  std::uint8_t intensity;
  float n[3];
};

std::vector<PcdPoint> pcd_points() {
  std::vector<PcdPoint> points;
  for (std::uint32_t i = 0; i < 6; ++i)
    points.push_back({0.1F * static_cast<float>(i),
                      1.0 / (i + 1),
                      -1.0F,
                      0xFF0000U >> (8 * (i % 3)),
                      static_cast<std::uint8_t>(50 * i),
                      {0, 0, 2}});
  points[4].x = std::numeric_limits<float>::quiet_NaN();
  points[2].x = 1;
  points[2].y = 2;
  points[2].z = 3;  // the sensor's own place: no point
  return points;
}

std::string pcd(const std::string& kind) {
  std::string text, rows, columns;
  for (const PcdPoint& p : pcd_points()) {
    text += fmt::format("{} {} 7 8 9 {} {} {} {} {} {}\n", p.x, p.y, p.z, std::bit_cast<float>(p.rgb),
                        p.intensity, p.n[0], p.n[1], p.n[2]);
    rows += raw(p.x) + raw(p.y) + std::string(6, 'x') + raw(p.z) + raw(p.rgb) + raw(p.intensity) +
            raw(p.n[0]) + raw(p.n[1]) + raw(p.n[2]);
  }
  const std::vector<PcdPoint> points = pcd_points();
  for (const auto& p : points) columns += raw(p.x);
  for (const auto& p : points) columns += raw(p.y);
  columns += std::string(6 * 6, 'x');
  for (const auto& p : points) columns += raw(p.z);
  for (const auto& p : points) columns += raw(p.rgb);
  for (const auto& p : points) columns += raw(p.intensity);
  for (int k = 0; k < 3; ++k)
    for (const auto& p : points) columns += raw(p.n[k]);
  if (kind == "ascii") return pcd_header(kind) + text;
  if (kind == "binary") return pcd_header(kind) + rows;
  const std::string codes = lzf(columns);
  return pcd_header(kind) + raw(static_cast<std::uint32_t>(codes.size())) +
         raw(static_cast<std::uint32_t>(columns.size())) + codes;
}

TEST(Pcd, TheThreeKindsHoldTheSame) {
  for (const std::string kind : {"ascii", "binary", "binary_compressed"}) {
    const RangeScan scan = scan_of("x.pcd", pcd(kind));
    ASSERT_EQ(scan.cloud.size(), 4U) << kind;
    // Text keeps what was written, bytes what float32 made of it.
    EXPECT_EQ(scan.cloud.positions[1], Eigen::Vector3d(kind == "ascii" ? 0.1 : 0.1F, 0.5, -1)) << kind;
    EXPECT_EQ(scan.cloud.colors[1], Eigen::Vector3f(0, 1, 0)) << kind;
    EXPECT_NEAR(scan.cloud.intensities[1], 50.0 / 255, 1e-7) << kind;
    EXPECT_EQ(scan.cloud.normals[1], Eigen::Vector3f(0, 0, 1)) << kind;
    ASSERT_TRUE(scan.grid) << kind;
    EXPECT_EQ(scan.grid->rows, 2);
    EXPECT_EQ(scan.grid->columns, 3);
    EXPECT_EQ(scan.grid->cells, (std::vector<std::int32_t>{0, 1, -1, 2, -1, 3})) << kind;
    EXPECT_EQ(scan.view.kind, ScanView::Kind::origin);
    EXPECT_EQ(scan.view.vector, Eigen::Vector3d(1, 2, 3));
  }
}

TEST(Pcd, LiesAreNamed) {
  const std::string head = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  expect_problem("x.pcd", head + "WIDTH 2\nHEIGHT 1\nPOINTS 3\nDATA ascii\n1 2 3\n", ": POINTS is 3");
  expect_problem("x.pcd", head + "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA ascii\n1.5 2.5 3.5\n",
                 ": the file ends after 1 of the 2");
  expect_problem("x.pcd", head + "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n4 5 6\n", ":11: ");
  expect_problem("x.pcd", head + "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1.0 2\n", ":10: too few");
  expect_problem("x.pcd", head + "WIDTH 2147483647\nHEIGHT 2147483647\nDATA binary\n1234", ": byte ");
  expect_problem("x.pcd", head + "WIDTH 2147483647\nHEIGHT 2147483647\nDATA ascii\n1234",
                 ": the header claims");
  expect_problem("x.pcd", head + "WIDTH -1\n", ":6: ");
  expect_problem("x.pcd", head + "WIDTH 1\nHEIGHT 1\nDATA binary_compressed\n" + raw(0xFFFFFFFFU) + raw(12U),
                 ": byte ");
  expect_problem("x.pcd", head + "WIDTH 1\nHEIGHT 1\nDATA binary_compressed\n" + raw(4U) + raw(13U) + "abcd",
                 ": byte ");
  expect_problem(
      "x.pcd", head + "WIDTH 1\nHEIGHT 1\nDATA binary_compressed\n" + raw(4U) + raw(12U) + "\xE0\x01\x02\x03",
      ": byte ");
  expect_problem("x.pcd",
                 head + "WIDTH 357913942\nHEIGHT 1\nDATA binary_compressed\n" + raw(2U) + raw(8U) +
                     std::string("\0a", 2),
                 ": byte ");
  expect_problem(
      "x.pcd", "VERSION .7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2\n",
      ": the points have no field \"z\"");
  expect_problem("x.pcd",
                 "VERSION .7\nFIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3\n",
                 ": field \"z\"");
  expect_problem("x.pcd", "VERSION .7\nFIELDS x y z\nSIZE 4 4\n", ":3: ");
  expect_problem("x.pcd", head, ":5: ");
}

TEST(Pcd, RealFiles) {
  struct Real {
    std::string name;
    std::size_t points;
    bool grid, color, normals, intensity;
  };
  for (const Real& real : {Real{"scans/formats/pcd/bun0.pcd", 397, false, false, true, false},
                           Real{"scans/formats/pcd/colored_cloud.pcd", 1000, false, true, true, false},
                           Real{"scans/formats/pcd/cturtle.pcd", 167198, false, false, false, true},
                           Real{"scans/formats/pcd/office1.pcd", 0, true, true, false, false},
                           Real{"scans/pcl_pairwise/capture0001.pcd", 0, true, false, false, false},
                           Real{"scans/pcl_room/room_scan1.pcd", 112586, false, false, false, false}}) {
    if (!test::have_data(real.name)) GTEST_SKIP() << "needs " << real.name << " of DRAPE_TEST_DATA";
    const RangeScan scan = io::read_scans(test::data(real.name)).at(0);
    if (real.points > 0) {
      EXPECT_EQ(scan.cloud.size(), real.points) << real.name;
    }
    EXPECT_EQ(scan.grid.has_value(), real.grid) << real.name;
    EXPECT_EQ(scan.cloud.colors.size(), real.color ? scan.cloud.size() : 0) << real.name;
    EXPECT_EQ(scan.cloud.normals.size(), real.normals ? scan.cloud.size() : 0) << real.name;
    EXPECT_EQ(scan.cloud.intensities.size(), real.intensity ? scan.cloud.size() : 0) << real.name;
    EXPECT_EQ(scan.view.kind, ScanView::Kind::origin) << real.name;
    if (real.grid) {
      // A depth camera: neighbours on the lattice are neighbours in space, and all lie before it.
      EXPECT_EQ(scan.grid->columns, 640);
      std::size_t near = 0, pairs = 0;
      for (int row = 0; row < scan.grid->rows; ++row)
        for (int column = 1; column < scan.grid->columns; ++column) {
          const std::int32_t a = scan.grid->at(row, column - 1), b = scan.grid->at(row, column);
          if (a < 0 || b < 0) continue;
          ++pairs;
          const Eigen::Vector3d& p = scan.cloud.positions[static_cast<std::size_t>(a)];
          if ((p - scan.cloud.positions[static_cast<std::size_t>(b)]).norm() < 0.02 * p.norm()) ++near;
        }
      EXPECT_GT(near, pairs * 95 / 100) << real.name;
    }
  }
}

TEST(Xyz, GuessesSeparatorHeaderAndColumns) {
  const auto expect = [](const std::string& text, bool colors, bool normals, bool intensity) {
    const RangeScan scan = scan_of("x.txt", text);
    ASSERT_EQ(scan.cloud.size(), 2U) << text;
    EXPECT_EQ(scan.cloud.positions[0], Eigen::Vector3d(1.5, -2, 3e-2)) << text;
    EXPECT_EQ(scan.cloud.positions[1], Eigen::Vector3d(4, 5, 6)) << text;
    EXPECT_EQ(scan.cloud.colors.size(), colors ? 2U : 0U) << text;
    EXPECT_EQ(scan.cloud.normals.size(), normals ? 2U : 0U) << text;
    EXPECT_EQ(scan.cloud.intensities.size(), intensity ? 2U : 0U) << text;
    if (colors) {
      EXPECT_EQ(scan.cloud.colors[0], Eigen::Vector3f(1, 0, 0.2F)) << text;
    }
    if (normals) {
      EXPECT_EQ(scan.cloud.normals[1], Eigen::Vector3f(0, 0, -1)) << text;
    }
    EXPECT_FALSE(scan.grid);
    EXPECT_EQ(scan.view.kind, ScanView::Kind::unknown);
  };
  expect("1.5 -2 3e-2\n4 5 6\n", false, false, false);
  expect(
      "\xEF\xBB\xBF"
      "1.5,-2,3e-2\r\n4,5,6\r\n",
      false, false, false);
  expect("1.5;-2;0.03;\n4;5;6;\n", false, false, false);
  expect("1,5;-2,0;0,03\n4,0;5,0;6,0\n", false, false, false);
  expect("1,5 -2,0 0,03\n4,0\t5,0  6,0\n", false, false, false);
  expect("# a comment\n1.5 -2 .03\n// another\n\n4 5 6", false, false, false);
  expect("2\n1.5 -2 .03\n4 5 6\n", false, false, false);
  expect("1.5 -2 .03 17\n4 5 6 255\n", false, false, true);
  expect("1.5 -2 .03 255 0 51\n4 5 6 1 2 3\n", true, false, false);
  expect("1.5 -2 .03 0 1 0\n4 5 6 0 0 -1\n", false, true, false);
  expect("1.5 -2 .03 100 255 0 51\n4 5 6 90 1 2 3\n", true, false, true);
  expect("1.5 -2 .03 -800 255 0 51 0 1 0\n4 5 6 90 1 2 3 0 0 -1\n", true, true, true);
  expect("//X,Y,Z,R,G,B,Intensity,Class\n1.5,-2,.03,255,0,51,7,tree\n4,5,6,1,2,3,8,\n", true, false, true);
  expect("y x z\n-2 1.5 .03\n5 4 6\n", false, false, false);
  expect("\"X [m]\";\"Y [m]\";\"Z [m]\";Nx;Ny;Nz\n1.5;-2;.03;0;1;0\n4;5;6;0;0;-1\n", false, true, false);
}

TEST(Xyz, TellsItsGuess) {
  const ScratchFolder folder;
  {
    const log::FileSink sink(folder / "log");
    (void)scan_of("x.csv", "a;b;c\n1;2;3\n");
  }
  const std::string text = read_file(folder / "log");
  EXPECT_NE(text.find("separated by \";\", 1 header lines, columns guessed: x y z"), std::string::npos)
      << text;
}

TEST(Xyz, ProblemsAreNamedWithTheirLine) {
  expect_problem("x.xyz", "", ": is empty");
  expect_problem("x.xyz", "hello\nworld\n", ":2: no line with three numbers");
  expect_problem("x.xyz", "1 2\n3 4\n", ":2: no line with three numbers");
  expect_problem("x.xyz", "1 2 3\n4 5\n", ":2: has 2 columns");
  expect_problem("x.xyz", "1 2 3\n4 5 6 7\n", ":2: has 4 columns");
  expect_problem("x.xyz", "1 2 3\n4 x 6\n", ":2: \"x\" is no number");
  expect_problem("x.csv", "1,2,3\n4,,6\n", ":2: \"\" is no number");
  expect_problem("x.xyz", std::string("1 2 3\n4 5\0 6\n", 13), ":2: ");
  expect_problem("x.xyz", "nan nan nan\n", ": holds no point");
  expect_problem("x.dat", "1 2 3\n", ": is no scan format");
}

TEST(StanfordConf, TheTransposeOfTheUsualMatrix) {
  const ScratchFolder folder;
  // A quarter turn round z: the usual matrix of q takes x to y, its transpose y to x.
  const double h = std::sqrt(0.5);
  write_file(
      folder / "a.conf",
      fmt::format("camera 0 0 0  0 0 0 1\n\nbmesh sub/a.ply 1 2 3 0 0 {} {}\nbmesh b.ply 0 0 0 0 0 0 1\n", h,
                  h));
  const auto poses = io::read_scan_poses(folder / "a.conf");
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_LT((poses.at("a.ply") * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(2, 2, 3)).norm(), 1e-12);
  EXPECT_EQ(poses.at("b.ply").matrix(), Rigid3::Identity().matrix());
  const auto problem = [&](const std::string& text) {
    write_file(folder / "b.conf", text);
    return error_message(ErrorCode::input, [&] { (void)io::read_scan_poses(folder / "b.conf"); });
  };
  EXPECT_NE(problem("bmesh a.ply 1 2 3 0 0 0\n").find("b.conf:1: "), std::string::npos);
  EXPECT_NE(problem("bmesh a.ply 1 2 3 0 0 0 0\n").find("b.conf:1: the quaternion"), std::string::npos);
  EXPECT_NE(problem("bmesh a.ply 1 2 3 0 0 0 1\nbmesh a.ply 1 2 3 0 0 0 1\n").find("b.conf:2: "),
            std::string::npos);
  EXPECT_NE(problem("hello\n").find("b.conf:1: "), std::string::npos);
  EXPECT_NE(problem("camera 0\n").find("holds no pose"), std::string::npos);
}

// The published poses bring the scans together. The surface then tells from where each scan was seen: at its
// points it faces the scanner (97 to 98 % of them face +z of the scan's own frame; the rest lies on edges).
// The lattice tells how the rays ran: x is 0.5 mm a column at any depth, so they are parallel.
TEST(StanfordConf, BunnyScansMeetAndWereSeenDownTheirZAxis) {
  if (!test::have_data("scans/bunny") || !test::have_data("meshes/bun_zipper.ply"))
    GTEST_SKIP() << "needs scans/bunny and meshes/bun_zipper.ply of DRAPE_TEST_DATA";
  const auto poses = io::read_scan_poses(test::data("scans/bunny/bun.conf"));
  EXPECT_EQ(poses.size(), 10U);
  const TriangleMesh zipper = io::read_mesh(test::data("meshes/bun_zipper.ply"));
  const std::vector<Eigen::Vector3f> normals = vertex_normals(zipper);
  const KdTree tree(zipper.vertices);
  for (const auto& [name, world_from_scan] : poses) {
    const RangeScan scan = io::read_scans(test::data("scans/bunny/" + name)).at(0);
    std::size_t seen = 0, facing = 0, close = 0;
    for (std::size_t i = 0; i < scan.cloud.size(); i += 20) {
      const Eigen::Vector3d& point = scan.cloud.positions[i];
      const Neighbor nearest = tree.nearest(world_from_scan * point, 1).at(0);
      const Eigen::Vector3d normal =
          world_from_scan.linear().transpose() * normals[nearest.index].cast<double>();
      ++seen;
      if (nearest.squared_distance < 1e-6) ++close;
      if (normal.dot(scan.view.towards_scanner(point)) > 0) ++facing;
    }
    EXPECT_GT(close, seen / 2) << name;
    EXPECT_GT(facing, seen * 95 / 100) << name;
    for (int row = 0; row < scan.grid->rows; row += 10)
      for (int column = 0; column < scan.grid->columns; ++column)
        if (const std::int32_t i = scan.grid->at(row, column); i != RangeGrid::missing) {
          EXPECT_NEAR(scan.cloud.positions[static_cast<std::size_t>(i)].x(), -0.12737 + 0.0005 * column,
                      0.0005)
              << name;
        }
  }
}

}  // namespace
}  // namespace drape
