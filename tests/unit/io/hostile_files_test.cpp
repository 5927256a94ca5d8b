// Damaged files of every scan and mesh format: each is read whole or refused, never half.
#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <functional>

#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/base/random.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/scan_files.hpp"
#include "picture_bytes.hpp"
#include "scan_bytes.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::raw;
using test::ScratchFolder;
using namespace std::string_literals;

/// How much a file gave: points or vertices, and faces or filled grid cells.
struct Yield {
  std::size_t points = 0;
  std::size_t parts = 0;
  bool operator==(const Yield&) const = default;
};
using Reader = std::function<Yield(const std::filesystem::path&)>;

Yield scan_yield(const std::filesystem::path& file) {
  Yield yield;
  io::ScanReadOptions options;
  options.depth = io::DepthCamera{{2, 2}, {}, 1, false};
  for (const RangeScan& scan : io::read_scans(file, options)) {
    yield.points += scan.cloud.size();
    if (!scan.grid) continue;
    EXPECT_EQ(scan.grid->cells.size(),
              static_cast<std::size_t>(scan.grid->rows) * static_cast<std::size_t>(scan.grid->columns));
    for (const std::int32_t cell : scan.grid->cells) {
      EXPECT_LT(cell, static_cast<std::int64_t>(scan.cloud.size()));
      if (cell >= 0) ++yield.parts;
    }
  }
  return yield;
}

Yield mesh_yield(const std::filesystem::path& file) {
  const TriangleMesh mesh = io::read_mesh(file);
  EXPECT_EQ(problem_of(mesh), "");
  return {mesh.vertices.size(), mesh.faces.size()};
}

struct Sample {
  std::string name;
  std::string bytes;
  Reader read;
  // Text without counts: what ends with a whole line is whole.
  bool open_ended = false;
};

std::string written(const std::string& name, const std::function<void(const std::filesystem::path&)>& write) {
  const ScratchFolder folder;
  write(folder / name);
  return read_file(folder / name);
}

RangeScan small_scan() {
  RangeScan scan;
  scan.cloud.positions = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  scan.cloud.normals.assign(3, Eigen::Vector3f::UnitZ());
  scan.cloud.colors.assign(3, Eigen::Vector3f::Ones());
  scan.grid = RangeGrid{2, 2, {0, -1, 2, 1}};
  scan.view = {ScanView::Kind::origin, {0, 0, 9}};
  scan.world_from_scan = Rigid3::Identity();
  return scan;
}

std::vector<Sample> samples();

/// And those that only scanners write.
std::vector<Sample> all_samples() {
  std::vector<Sample> all = samples();
  for (const test::ScanFile& file : test::scanner_files())
    all.push_back({file.name, file.bytes, scan_yield, file.open_ended});
  return all;
}

std::vector<Sample> samples() {
  const TriangleMesh box = test::box({0, 0, 0}, {1, 2, 3});
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 2\nproperty list uchar int vertex_indices\n";
  const std::string pcd =
      "VERSION .7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT "
      "0 0 0 1 0 0 0\nPOINTS 4\nDATA ";
  std::string values, text;
  for (int i = 0; i < 16; ++i) {
    values += raw(1.5F * static_cast<float>(i + 1), false);
    text += std::to_string(i + 1) + ".25" + (i % 4 == 3 ? "\n" : " ");
  }
  std::string codes;
  for (std::size_t at = 0; at < values.size(); at += 32) codes += '\x1F' + values.substr(at, 32);
  const std::string corners = "0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n";
  const auto big = [](float x) { return raw(x, true); };
  return {
      {"written.ply", written("x.ply", [](const auto& file) { io::write_scan_ply(file, small_scan()); }),
       scan_yield},
      {"ascii.ply",
       "ply\nformat ascii 1.0\nobj_info num_cols 2\nobj_info num_rows 1\nelement vertex 2\n" + xyz +
           "element range_grid 2\nproperty list uchar int vertex_indices\nend_header\n1.5 2.5 3.5\n4 5 6\n1 "
           "1\n1 0\n",
       scan_yield},
      {"big.ply",
       "ply\nformat binary_big_endian 1.0\nelement vertex 2\n" + xyz + "end_header\n" + big(1) + big(2) +
           big(3) + big(4) + big(5) + big(6),
       scan_yield},
      {"ascii.pcd", pcd + "ascii\n" + text, scan_yield},
      {"binary.pcd", pcd + "binary\n" + values, scan_yield},
      {"compressed.pcd",
       pcd + "binary_compressed\n" + raw(static_cast<std::uint32_t>(codes.size()), false) + raw(64U, false) +
           codes,
       scan_yield},
      {"points.xyz", "x,y,z,nx,ny,nz\n1.5,2.5,3.5,0,0,1\n4,5,6,0,1,0\n7,8,9,1,0,0\n", scan_yield, true},
      {"mesh.ply", written("x.ply", [&](const auto& file) { io::write_mesh_ply(file, box); }), mesh_yield},
      {"ascii_mesh.ply",
       "ply\nformat ascii 1.0\nelement vertex 4\n" + xyz + faces + "end_header\n" + corners +
           "3 0 1 2\n4 0 1 2 3\n",
       mesh_yield},
      {"mesh.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nv 0 1 0\nf 1 3 4\n", mesh_yield,
       true},
      {"mesh.off", "OFF\n4 2 0\n" + corners + "3 0 1 2\n4 0 1 2 3\n", mesh_yield},
      {"ascii.stl",
       "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
       "0\nendloop\nendfacet\nendsolid\n",
       mesh_yield},
      {"binary.stl",
       std::string(80, 'h') + raw(1U, false) + std::string(12, '\0') + raw(0.0F, false) + raw(0.0F, false) +
           raw(0.0F, false) + raw(1.0F, false) + raw(0.0F, false) + raw(0.0F, false) + raw(0.0F, false) +
           raw(1.0F, false) + raw(0.0F, false) + "ab",
       mesh_yield},
  };
}

class HostileFiles : public testing::Test {
 protected:
  void SetUp() override { log::set_console_level(log::Level::warning); }
  void TearDown() override { log::set_console_level(log::Level::info); }

  /// What the file gives, or nothing where it is refused as bad input. Anything else fails the test.
  std::optional<Yield> yield_of(const Sample& sample, const std::string& bytes) {
    // Replacing a file makes some file systems flush it; a new one does not.
    std::filesystem::remove(folder_ / sample.name);
    write_file(folder_ / sample.name, bytes);
    try {
      return sample.read(folder_ / sample.name);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::input) << error.what();
      EXPECT_NE(std::string(error.what()).find(sample.name + ":"), std::string::npos) << error.what();
      return std::nullopt;
    }
  }

  const ScratchFolder folder_;
};

TEST_F(HostileFiles, TruncatedAtEveryByte) {
  for (const Sample& sample : all_samples()) {
    const auto whole = yield_of(sample, sample.bytes);
    ASSERT_TRUE(whole) << sample.name;
    EXPECT_GT(whole->points, 0U) << sample.name;
    std::size_t refused = 0;
    for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
      const auto part = yield_of(sample, sample.bytes.substr(0, size));
      if (!part) ++refused;
      if (part && sample.open_ended) {
        EXPECT_LE(part->points, whole->points) << sample.name << " at " << size;
      } else if (part) {
        EXPECT_EQ(part, whole) << sample.name << " at " << size;
      }
    }
    EXPECT_GT(refused, sample.open_ended ? 5U : sample.bytes.size() * 9 / 10) << sample.name;
  }
}

TEST_F(HostileFiles, ChangedAtRandom) {
  Rng rng(11);
  for (const Sample& sample : all_samples())
    for (int i = 0; i < 400; ++i) {
      std::string bytes = sample.bytes;
      const std::uint64_t changes = 1 + rng.below(4);
      for (std::uint64_t k = 0; k < changes; ++k) {
        const std::size_t at = rng.below(bytes.size());
        switch (rng.below(4)) {
          case 0:
            bytes[at] = static_cast<char>(rng.below(256));
            break;
          case 1:
            bytes.erase(at, 1 + rng.below(5));
            break;
          case 2:
            bytes.insert(at, std::string(1 + rng.below(4), static_cast<char>('0' + rng.below(10))));
            break;
          default:
            bytes.replace(at, std::min<std::size_t>(4, bytes.size() - at),
                          std::string("\xFF\xFF\xFF\x7F").substr(0, 4));
            break;
        }
        if (bytes.empty()) bytes = "x";
      }
      (void)yield_of(sample, bytes);
    }
}

// Where the system has not generated the locale, it is compiled into a folder of the test's own.
bool set_locale_with_decimal_comma(const std::filesystem::path& folder) {
  if (std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr) return true;
  const std::string command =
      "localedef -i de_DE -f UTF-8 '" + (folder / "de_DE.UTF-8").string() + "' >/dev/null 2>&1";
  if (std::system(command.c_str()) != 0) return false;
  ::setenv("LOCPATH", folder.c_str(), 1);
  return std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
}

TEST_F(HostileFiles, AnotherLocaleChangesNothing) {
  // A decimal comma in the C locale is what makes readers by scanf and strtod lose every fraction.
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const Eigen::Vector3d half = io::parse_scans("a.xyz", "0.5 1.5 2.5\n1 2 3.25\n").at(0).cloud.positions[0];
  if (!set_locale_with_decimal_comma(folder_.path())) GTEST_SKIP() << "needs the package locales";
  ASSERT_EQ(std::localeconv()->decimal_point, ","s);
  EXPECT_EQ(io::parse_scans("a.xyz", "0.5 1.5 2.5\n1 2 3.25\n").at(0).cloud.positions[0], half);
  for (const Sample& sample : all_samples()) EXPECT_TRUE(yield_of(sample, sample.bytes)) << sample.name;
  std::setlocale(LC_ALL, before.c_str());
}

TEST_F(HostileFiles, NothingAtAll) {
  for (const Sample& sample : all_samples()) {
    EXPECT_FALSE(yield_of(sample, "")) << sample.name;
    EXPECT_FALSE(yield_of(sample, std::string(300, '\0'))) << sample.name;
    EXPECT_FALSE(yield_of(sample, "\n\n\n")) << sample.name;
    EXPECT_NE(
        test::error_message(ErrorCode::input, [&] { (void)sample.read(folder_ / "none" / sample.name); })
            .find("no such file"),
        std::string::npos);
    EXPECT_NE(
        test::error_message(ErrorCode::input, [&] { (void)sample.read(folder_.path()); }).find("is a folder"),
        std::string::npos);
  }
}

}  // namespace
}  // namespace drape
