// Large scans told from their header and a part of their points.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "drape/base/files.hpp"
#include "drape/io/scan_files.hpp"
#include "picture_bytes.hpp"
#include "scan_bytes.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::raw;
using test::ScratchFolder;

constexpr int columns = 1200;
constexpr int rows = 1000;  // more than are read whole

// Lines of a plane, half a unit apart, at a height that names the row.
template <class Write>
void for_each_point(const Write& write) {
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      write(0.5F * static_cast<float>(column), static_cast<float>(row), 7.0F);
}

std::string floats() {
  std::string bytes;
  bytes.reserve(12UL * rows * columns);
  for_each_point([&](float x, float y, float z) {
    for (const float v : {x, y, z}) bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  });
  return bytes;
}

void expect_plane(const io::ScanSample& sample) {
  EXPECT_EQ(sample.points, static_cast<std::uint64_t>(rows) * columns);
  const auto& points = sample.scan.cloud.positions;
  ASSERT_EQ(points.size(), 262'144U);
  EXPECT_EQ(points.front(), Eigen::Vector3d(0, 0, 7));
  EXPECT_GE(points.back().y(), rows - 2);
  for (std::size_t i = 0; i < points.size(); i += sample.run_points)
    EXPECT_NEAR(points[i + 1].x() - points[i].x(), points[i + 1].y() > points[i].y() ? -599.5 : 0.5, 1e-9);
}

TEST(ScanSample, OfBinaryPlyWithAGrid) {
  const ScratchFolder folder;
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nobj_info num_cols 1200\nobj_info num_rows 1000\nelement vertex "
      "1200000\nproperty float x\nproperty float y\nproperty float z\nelement range_grid 1200000\nproperty "
      "list uchar int vertex_indices\nend_header\n" +
      floats();
  for (int i = 0; i < rows * columns; ++i) bytes += '\1' + raw(i, false);
  write_file(folder / "a.ply", bytes);
  const auto sample = io::sample_scan(folder / "a.ply");
  ASSERT_TRUE(sample);
  expect_plane(*sample);
  EXPECT_EQ(sample->rows, rows);
  EXPECT_EQ(sample->columns, columns);
}

TEST(ScanSample, OfBinaryPcd) {
  const ScratchFolder folder;
  write_file(folder / "a.pcd",
             "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1200\nHEIGHT "
             "1000\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 1200000\nDATA binary\n" +
                 floats());
  const auto sample = io::sample_scan(folder / "a.pcd");
  ASSERT_TRUE(sample);
  expect_plane(*sample);
  EXPECT_EQ(sample->rows, rows);
  EXPECT_EQ(sample->scan.view.vector, Eigen::Vector3d(1, 2, 3));
}

TEST(ScanSample, OfLasTellsTheBoxOfTheHeader) {
  const ScratchFolder folder;
  std::string bytes = test::las_bytes(2, 0);
  std::uint16_t record_size = 0;  // some bytes more than the point format has
  std::memcpy(&record_size, bytes.data() + 105, 2);
  const std::string header = bytes.substr(0, bytes.size() - 3UL * record_size);
  std::string large = header;
  const std::uint32_t count = 1'200'000;
  std::memcpy(large.data() + 107, &count, 4);
  const double most = 12345;
  std::memcpy(large.data() + 179, &most, 8);
  const std::string record = bytes.substr(header.size(), record_size);
  large.reserve(large.size() + std::size_t{record_size} * count);
  for (std::uint32_t i = 0; i < count; ++i) large += record;
  write_file(folder / "a.las", large);
  const auto sample = io::sample_scan(folder / "a.las");
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->points, count);
  EXPECT_EQ(sample->scan.cloud.size(), 262'144U);
  ASSERT_TRUE(sample->stated_box);
  EXPECT_EQ(sample->stated_box->max().x(), most);
}

TEST(ScanSample, NotOfWhatHasToBeReadWhole) {
  const ScratchFolder folder;
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1200000\nproperty float x\nproperty float "
      "y\nproperty float z\n";
  const std::string points = floats();
  for (const auto& [what, bytes] :
       {std::pair{"small", std::string("ply\nformat ascii 1.0\nelement vertex 1\n"
                                       "property float x\nproperty float y\n"
                                       "property float z\nend_header\n1 2 3\n")},
        {"cut", header + "end_header\n" + points.substr(12)},
        {"mesh", header +
                     "element face 1\nproperty list uchar int "
                     "vertex_indices\nend_header\n" +
                     points + '\3' + raw(0, false) + raw(1, false) + raw(2, false)},
        {"text", std::string("1 2 3\n4 5 6\n")}}) {
    const auto file = folder / (std::string(what) + (what == std::string("text") ? ".xyz" : ".ply"));
    write_file(file, bytes);
    EXPECT_FALSE(io::sample_scan(file)) << what;
  }
}

}  // namespace
}  // namespace drape
