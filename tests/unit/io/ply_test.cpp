// Dialects and lies of PLY, through the readers that users have.
#include <gtest/gtest.h>

#include <bit>
#include <string>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/scan_files.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::error_message;
using test::ScratchFolder;

std::vector<RangeScan> scans_of(const std::string& bytes) {
  const ScratchFolder folder;
  write_file(folder / "x.ply", bytes);
  return io::read_scans(folder / "x.ply");
}

TriangleMesh mesh_of(const std::string& bytes) {
  const ScratchFolder folder;
  write_file(folder / "x.ply", bytes);
  return io::read_mesh(folder / "x.ply");
}

/// The part of the message after the folder.
std::string input_problem(const std::string& bytes) {
  const std::string message = error_message(ErrorCode::input, [&] { (void)scans_of(bytes); });
  const std::size_t at = message.find("x.ply");
  return at == std::string::npos ? message : message.substr(at);
}

template <class Number>
std::string raw(Number value, bool big_endian = false) {
  auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return {bytes.begin(), bytes.end()};
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";

TEST(Ply, AsciiWithUnknownElementsAndProperties) {
  const auto scans = scans_of(
      "ply\nformat ascii 1.0\ncomment a b\nobj_info c\nelement thing 1\nproperty list uchar float "
      "what\nproperty int n\n"
      "element vertex 2\nproperty list uchar int l\nproperty double x\nproperty uchar red\nproperty float y\n"
      "property float z\nproperty uchar green\nproperty uchar blue\nelement nothing 7\nelement tail 1\n"
      "property short s\nend_header\n2 1.5 2.5 -7\n\n0 1e-3 255 2 3 0 51\n2 8 9 -1 0 +5 6 255 0\n-3\n");
  const PointCloud& cloud = scans.at(0).cloud;
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.positions[0], Eigen::Vector3d(1e-3, 2, 3));
  EXPECT_EQ(cloud.positions[1], Eigen::Vector3d(-1, 5, 6));
  EXPECT_EQ(cloud.colors[0], Eigen::Vector3f(1, 0, 0.2F));
  EXPECT_EQ(cloud.colors[1], Eigen::Vector3f(0, 1, 0));
}

TEST(Ply, LineEnds) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 2\n" + xyz + "end_header\n1 2 3\n4 5 6\n";
  for (const std::string end : {"\r\n", "\r"}) {
    std::string other;
    for (const char c : text) other += c == '\n' ? end : std::string(1, c);
    EXPECT_EQ(scans_of(other).at(0).cloud.positions.at(1), Eigen::Vector3d(4, 5, 6));
  }
  // The first byte of a binary value may look like the second half of a line end.
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string header;
    for (const char c : "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + xyz + "end_header\n")
      header += c == '\n' ? end : std::string(1, c);
    const float tricky = std::bit_cast<float>(std::uint32_t{0x40000D0A});
    EXPECT_EQ(scans_of(header + raw(tricky) + raw(2.0F) + raw(3.0F)).at(0).cloud.positions.at(0),
              Eigen::Vector3d(tricky, 2, 3));
  }
}

TEST(Ply, EveryTypeInBothByteOrders) {
  for (const bool big : {false, true}) {
    const std::string bytes =
        std::string("ply\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\nelement camera 1\nproperty float view_px\nproperty float view_py\nproperty float "
        "view_pz\n"
        "element vertex 1\nproperty char a\nproperty uint8 b\nproperty list ushort int16 c\nproperty short "
        "x\n"
        "property uint d\nproperty double y\nproperty int z\nproperty ushort intensity\nend_header\n" +
        raw(7.0F, big) + raw(8.0F, big) + raw(9.0F, big) +  //
        raw(std::int8_t{-1}) + raw(std::uint8_t{200}) + raw(std::uint16_t{2}, big) +
        raw(std::int16_t{5}, big) + raw(std::int16_t{6}, big) + raw(std::int16_t{-300}, big) +
        raw(std::uint32_t{4000000000}, big) + raw(-1.25e200, big) + raw(std::int32_t{-70000}, big) +
        raw(std::uint16_t{65535}, big);
    const RangeScan scan = scans_of(bytes).at(0);
    EXPECT_EQ(scan.cloud.positions.at(0), Eigen::Vector3d(-300, -1.25e200, -70000));
    EXPECT_EQ(scan.cloud.intensities.at(0), 1.0F);
    EXPECT_EQ(scan.view.kind, ScanView::Kind::origin);
    EXPECT_EQ(scan.view.vector, Eigen::Vector3d(7, 8, 9));
  }
}

TEST(Ply, ForeignAttributesAreBroughtToOurMeaning) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz;
  const PointCloud floats =
      scans_of(head +
               "property float nx\nproperty float ny\nproperty float nz\nproperty float red\n"
               "property float green\nproperty float blue\nproperty float intensity\n"
               "property float confidence\nend_header\n0 0 0 0 3 4 0 127.5 255 -2048 2\n"
               "0 0 1 nan 0 0 nan 0 300 2047 nan\n1 0 0 0 0 0 51 1 2 -0.5 0.25\n")
          .at(0)
          .cloud;
  EXPECT_EQ(floats.normals, (std::vector<Eigen::Vector3f>{{0, 0.6F, 0.8F}, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(floats.colors[2], Eigen::Vector3f(51.0F / 65535, 1.0F / 65535, 2.0F / 65535));
  EXPECT_EQ(floats.colors[1].x(), 0.0F);
  EXPECT_EQ(floats.intensities, (std::vector<float>{0, 1, 0.5F}));
  EXPECT_EQ(floats.confidences, (std::vector<float>{1, 0, 0.25F}));
  const PointCloud shorts =
      scans_of(head +
               "property ushort red\nproperty ushort green\nproperty ushort blue\nproperty uchar intensity\n"
               "end_header\n0 0 0 65535 0 1 51\n0 0 1 0 0 0 0\n0 0 2 0 0 0 0\n")
          .at(0)
          .cloud;
  EXPECT_EQ(shorts.colors[0], Eigen::Vector3f(1, 0, 1.0F / 65535));
  EXPECT_EQ(shorts.intensities[0], 0.2F);
}

TEST(Ply, PointsThatAreNotFiniteAreLeftOutAndTheGridFollows) {
  const RangeScan scan =
      scans_of("ply\nformat ascii 1.0\nobj_info num_cols 2\nobj_info num_rows 2\nelement vertex 3\n" + xyz +
               "property float confidence\nelement range_grid 4\nproperty list uchar int "
               "vertex_indices\nend_header\n"
               "nan 0 0 .1\n1 2 3 .2\n4 5 6 .3\n1 2\n1 0\n0\n1 1\n")
          .at(0);
  ASSERT_EQ(scan.cloud.size(), 2U);
  EXPECT_EQ(scan.cloud.confidences, (std::vector<float>{0.2F, 0.3F}));
  ASSERT_TRUE(scan.grid);
  EXPECT_EQ(scan.grid->cells, (std::vector<std::int32_t>{1, -1, -1, 0}));
}

TEST(Ply, PolygonsStripsAndMarks) {
  const TriangleMesh mesh = mesh_of(
      "ply\nformat ascii 1.0\nelement face 2\nproperty uchar filled\nproperty list uchar uint vertex_index\n"
      "element vertex 5\n" +
      xyz + "end_header\n0 4 0 1 2 3\n1 3 2 3 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 2 0\n");
  EXPECT_EQ(mesh.faces, (std::vector<Face>{{0, 1, 2}, {0, 2, 3}, {2, 3, 4}}));
  EXPECT_EQ(mesh.filled, (std::vector<std::uint8_t>{0, 0, 1}));
  const TriangleMesh strips =
      mesh_of("ply\nformat ascii 1.0\nelement vertex 5\n" + xyz +
              "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
              "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 2 0\n8 0 1 2 3 -1 2 3 4\n");
  EXPECT_EQ(strips.faces, (std::vector<Face>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
}

TEST(Ply, LiesAreNamedWithTheirPlace) {
  const std::string ascii = "ply\nformat ascii 1.0\n";
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  const auto expect = [](const std::string& bytes, const std::string& place, const std::string& what) {
    const std::string problem = input_problem(bytes);
    EXPECT_TRUE(problem.starts_with("x.ply" + place)) << problem;
    EXPECT_NE(problem.find(what), std::string::npos) << problem;
  };
  expect("", ": ", "is empty");
  expect("ply\n", ":", "end_header");
  expect("plyx\nformat ascii 1.0\nend_header\n", ":1: ", "\"ply\"");
  expect(ascii + "element vertex 1\n" + xyz, ":", "truncated");
  expect("ply\nelement vertex 0\n" + xyz + "end_header\n", ":6: ", "format");
  expect("ply\nformat ebcdic 1.0\n", ":2: ", "ebcdic");
  expect(ascii + "element vertex -1\n", ":3: ", "count");
  expect(ascii + "element vertex 99999999999999999999\n", ":3: ", "count");
  expect(ascii + "element vertex\n", ":3: ", "count");
  expect(ascii + "property float x\n", ":3: ", "before any element");
  expect(ascii + "element vertex 1\nproperty quad x\n", ":4: ", "quad");
  expect(ascii + "element vertex 1\nproperty list float int x\n", ":4: ", "whole number");
  expect(ascii + "element vertex 1\nproperty float x\nproperty float x\n", ":5: ", "twice");
  expect(ascii + std::string("elem\0nt", 7) + " vertex 1\n", ":3: ", "unknown");
  expect(ascii + "element vertex 1\nproperty float x\nend_header\n1\n", ": ", "x, y and z");
  expect(ascii + "element vertex 0\n" + xyz + "end_header\n", ": ", "no point");
  // Counts against bytes.
  const std::string vertices =
      "element vertex 4294967295\nproperty double x\nproperty double y\nproperty double z\nend_header\n";
  expect(ascii + vertices + "1 2 3\n", ":3: ", "claims 4294967295 rows");
  expect(binary + vertices + "123", ": byte ", "claims 4294967295 rows");
  expect(binary + "element vertex 18446744073709551615\n" + xyz + "end_header\n", ": byte ", "claims");
  expect(ascii + "element vertex 2\n" + xyz + "end_header\n1.00 2.00 3.00\n", ": ", "after 1 of the 2 rows");
  expect(ascii + "element vertex 1\n" + xyz + "end_header\n1 2 3\n4 5 6\n", ":9: ", "go on");
  expect(binary + "element vertex 1\n" + xyz + "end_header\n" + raw(1.0F) + raw(1.0F) + raw(1.0F) + "x",
         ": byte ", "1 bytes follow");
  expect(ascii + "element vertex 1\n" + xyz + "end_header\n1.25 2\n", ":8: ", "too few");
  expect(ascii + "element vertex 1\n" + xyz + "end_header\n1 2 3 4\n", ":8: ", "more values");
  expect(ascii + "element vertex 1\n" + xyz + "end_header\n1 2 x\n", ":8: ", "no number");
  expect(ascii + "element vertex 1\n" + xyz + "end_header\n1 2 0,5\n", ":8: ", "no number");
  expect(ascii + "element vertex 1\n" + xyz + "property uchar red\nend_header\n1 2 3 256\n",
         ":9: ", "does not fit");
  expect(ascii + "element vertex 1\n" + xyz + "property list uchar int l\nend_header\n1 2 3 200000 1\n",
         ":9: ", "claims 200000");
  expect(ascii + "element vertex 1\n" + xyz + "property list char int l\nend_header\n1 2 3 -1\n",
         ":9: ", "no length");
  expect(binary + "element vertex 1\nproperty list uint double l\n" + xyz + "end_header\n" +
             raw(0xFFFFFFFFU) + std::string(12, '\0'),
         ": byte ", "claims 4294967295 entries");
  expect(binary + "element vertex 1\nproperty list char double l\n" + xyz + "end_header\n" +
             raw(std::int8_t{-1}) + std::string(12, '\0'),
         ": byte ", "no length");
  // What drape's own header lines say.
  const std::string point = "element vertex 1\n" + xyz + "end_header\n1 2 3\n";
  expect(ascii + "obj_info view_direction 0 0 2\n" + point, ": ", "view_direction has length 2");
  expect(ascii + "obj_info view_origin 0 0\n" + point, ": ", "should have 3 numbers");
  expect(ascii + "obj_info world_from_scan 1 0 0 0 0 1 0 0 0 0 2 0\n" + point, ": ", "no rigid motion");
  // Grids.
  const std::string grid =
      "element range_grid 4\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n";
  expect(
      ascii + "obj_info num_cols 2\nobj_info num_rows 2\nelement vertex 1\n" + xyz + grid + "0\n1 1\n0\n0\n",
      ":14: ", "out of range");
  expect(
      ascii + "obj_info num_cols 2\nobj_info num_rows 2\nelement vertex 1\n" + xyz + grid + "0\n1 -1\n0\n0\n",
      ":14: ", "out of range");
  expect(ascii + "obj_info num_cols 2\nobj_info num_rows 2\nelement vertex 1\n" + xyz + grid +
             "0\n2 0 0\n0\n0\n",
         ":14: ", "more than one");
  expect(ascii + "obj_info num_cols 3\nobj_info num_rows 2\nelement vertex 1\n" + xyz + grid + "0\n0\n0\n0\n",
         ":9: ", "4 cells");
}

TEST(Ply, AFaceMayNotNameWhatIsNotThere) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz +
                           "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const std::string face : {"3 0 1 3", "3 0 1 -1", "3 999999 0 1"})
    EXPECT_NE(
        error_message(ErrorCode::input, [&] { (void)mesh_of(head + "0 0 0\n1 0 0\n0 1 0\n" + face + "\n"); })
            .find("x.ply:13: "),
        std::string::npos)
        << face;
  EXPECT_NE(error_message(ErrorCode::input, [&] { (void)mesh_of(head + "0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n"); })
                .find("x.ply:13: the face uses vertex 1"),
            std::string::npos);
}

}  // namespace
}  // namespace drape
