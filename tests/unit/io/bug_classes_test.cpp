// The kinds of bugs that readers of such files have had, each tried on every format that it can befall. Files
// cut anywhere, and another locale: hostile_files_test.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstring>
#include <functional>
#include <limits>

#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/scan_files.hpp"
#include "picture_bytes.hpp"
#include "scan_bytes.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::raw;

enum class As { scan_and_mesh, scan, mesh };

struct Bad {
  std::string name;
  std::string bytes;
  As as = As::scan_and_mesh;
};

double peak_megabytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

// As scans and, where the format has faces, as meshes.
void expect_refused(const std::vector<Bad>& files) {
  log::set_console_level(log::Level::warning);
  io::ScanReadOptions options;
  options.depth = io::DepthCamera{{2, 2}, {}, 1, false};
  const double before = peak_megabytes();
  for (const Bad& bad : files) {
    SCOPED_TRACE(bad.name + ": " + bad.bytes.substr(0, 200));
    const std::string ending = bad.name.substr(bad.name.rfind('.') + 1);
    if (bad.as != As::scan && (ending == "obj" || ending == "off" || ending == "stl" || ending == "ply")) {
      const test::ScratchFolder folder;
      write_file(folder / bad.name, bad.bytes);
      EXPECT_NE(test::error_message(ErrorCode::input, [&] { (void)io::read_mesh(folder / bad.name); }), "");
    }
    if (bad.as == As::mesh) continue;
    const std::string problem =
        test::error_message(ErrorCode::input, [&] { (void)io::parse_scans(bad.name, bad.bytes, options); });
    EXPECT_EQ(problem.find(bad.name), 0U) << problem;
  }
  EXPECT_LT(peak_megabytes() - before, 100);
  log::set_console_level(log::Level::info);
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string list = "property list uint int vertex_indices\nend_header\n";

std::string ply(const std::string& format, const std::string& count) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + count + "\n" + xyz;
}

std::string zeros(std::size_t count) {
  return std::string(count, '\0');
}

std::string changed(std::string bytes, std::size_t at, const std::string& by) {
  return bytes.replace(at, by.size(), by);
}

const std::string ptx_header = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

std::string pcd(const std::string& size) {
  return "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + size;
}

// With one field changed by `change`.
std::string e57(const std::function<void(test::E57Maker::Scan&)>& change) {
  test::E57Maker maker;
  maker.scans.push_back(test::e57_scan_of_all_kinds());
  change(maker.scans[0]);
  return maker.bytes();
}

TEST(BugClasses, ListLengthThatLies) {
  expect_refused({
      {"a.ply", ply("ascii", "3") + "element face 1\n" + list + "0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n"},
      {"a.ply", ply("binary_little_endian", "3") + "element face 1\n" + list + zeros(36) +
                    raw(0xFFFFFFFFU, false) + zeros(12)},
      {"a.ply", ply("binary_big_endian", "3") + "element face 1\n" + list + zeros(36) +
                    raw(0xFFFFFFF0U, true) + zeros(12)},
      {"a.ply", ply("binary_little_endian", "1") +
                    "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + zeros(12) +
                    raw(-1, false) + zeros(12)},
      {"a.ply",
       "ply\nformat binary_little_endian 1.0\nobj_info num_cols 1\nobj_info num_rows 1\nelement vertex "
       "1\n" +
           xyz + "element range_grid 1\nproperty list uchar int vertex_indices\nend_header\n" + zeros(12) +
           "\xFF" + zeros(4)},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4294967295 0 1 2\n"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"},
  });
}

TEST(BugClasses, CountThatDrivesAllocation) {
  const std::string las = test::las_bytes(2, 0);
  const std::string las14 = test::las_bytes(4, 6);
  expect_refused({
      {"a.ply", ply("ascii", "1000000000000") + "end_header\n1 2 3\n"},
      {"a.ply", ply("binary_little_endian", "1000000000000") + "end_header\n" + zeros(12)},
      {"a.ply", ply("binary_little_endian", "1") + "element face 4000000000\n" + list + zeros(40)},
      {"a.pcd", pcd("WIDTH 1000000000\nHEIGHT 1\nDATA ascii\n1 2 3\n")},
      {"a.pcd", pcd("WIDTH 1000000000\nHEIGHT 1\nDATA binary\n") + zeros(12)},
      {"a.pcd", pcd("WIDTH 100000000\nHEIGHT 1\nDATA binary_compressed\n") + raw(8U, false) +
                    raw(1'200'000'000U, false) + zeros(8)},
      {"a.las", changed(las, 107, raw(0xFFFFFFFFU, false))},
      {"a.las", changed(las14, 247, raw(std::uint64_t{1} << 40, false))},
      {"a.e57", e57([](auto& scan) { scan.claimed_records = 1'000'000'000; })},
      {"a.ptx", "100000000\n100000000\n" + ptx_header + "1 2 3\n"},
      {"a.off", "OFF\n2000000000 1 0\n0 0 0\n"},
      {"a.off", "OFF\n3 2000000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"a.stl", zeros(80) + raw(0xFFFFFFFFU, false) + zeros(50)},
      {"a.png", changed(test::png_file(1, 1, 16, 0, {zeros(2)}), 16, raw(0x7FFFFFFFU, true))},
      {"a.exr", changed(test::depth_exr(1, 1, {1}), test::depth_exr(1, 1, {1}).find("box2i") + 6 + 4 + 8,
                        raw(100'000'000, false) + raw(100'000'000, false))},
  });
}

TEST(BugClasses, IndexOutOfRange) {
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";
  const auto faces = [&](const std::string& kind, const std::string& face) {
    return ply("ascii", "3") + "element " + kind + " 1\nproperty list int int vertex_indices\nend_header\n" +
           corners + face + "\n";
  };
  expect_refused({
      {"a.ply", faces("face", "3 0 1 3"), As::mesh},
      {"a.ply", faces("face", "3 0 1 -2147483648"), As::mesh},
      {"a.ply", faces("tristrips", "3 0 1 999999"), As::mesh},
      {"a.ply", faces("tristrips", "3 0 1 -2"), As::mesh},
      {"a.ply",
       "ply\nformat ascii 1.0\nobj_info num_cols 1\nobj_info num_rows 1\nelement vertex 1\n" + xyz +
           "element range_grid 1\nproperty list uchar int vertex_indices\nend_header\n1 2 3\n1 1\n",
       As::scan},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 999999//1 2 3\n"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"},
      {"a.off", "OFF\n3 1 0\n" + corners + "3 0 1 3\n"},
      {"a.off", "OFF\n3 1 0\n" + corners + "3 0 1 -1\n"},
  });
}

TEST(BugClasses, IntegerOverflow) {
  const std::string las14 = changed(test::las_bytes(4, 6), 105, raw(std::uint16_t{32}, false));
  // Times 12, 32 and 50 bytes these wrap to next to nothing.
  const std::string twelfth = "1537228672809129302";
  expect_refused({
      {"a.ply", ply("binary_little_endian", twelfth) + "end_header\n" + zeros(24)},
      {"a.ply", ply("ascii", "18446744073709551616") + "end_header\n1 2 3\n"},
      {"a.pcd", pcd("WIDTH 2147483648\nHEIGHT 2147483648\nDATA binary\n") + zeros(12)},
      {"a.pcd",
       "VERSION .7\nFIELDS x y z _\nSIZE 4 4 4 8\nTYPE F F F F\nCOUNT 1 1 1 1048576\nWIDTH "
       "2147483648\nHEIGHT 1048576\nDATA binary\n" +
           zeros(12)},
      {"a.las", changed(las14, 247, raw(std::uint64_t{1} << 59, false))},
      {"a.e57", e57([](auto& scan) { scan.claimed_records = std::int64_t{1} << 61; })},
      {"a.ptx", "65536\n65537\n" + ptx_header + "1 2 3\n"},
      {"a.stl", zeros(80) + raw(85'899'346U, false) + zeros(4)},
      {"a.png", changed(test::png_file(1, 1, 16, 0, {zeros(2)}), 16, raw(65536U, true) + raw(65536U, true))},
      {"a.exr",
       changed(test::depth_exr(1, 1, {1}), test::depth_exr(1, 1, {1}).find("box2i") + 6 + 4,
               raw(std::numeric_limits<int>::min(), false) + raw(std::numeric_limits<int>::min(), false) +
                   raw(std::numeric_limits<int>::max(), false) +
                   raw(std::numeric_limits<int>::max(), false))},
  });
}

TEST(BugClasses, NothingWhereAWordShouldBe) {
  expect_refused({
      {"a.ply", "ply\nformat\nelement vertex 1\n" + xyz + "end_header\n1 2 3\n"},
      {"a.ply", "ply\nformat ascii 1.0\nelement\n"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty\nend_header\n1\n"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar\nend_header\n1\n"},
      {"a.pcd", "VERSION .7\nFIELDS\nSIZE\nTYPE\nCOUNT\nWIDTH\nHEIGHT\nDATA\n"},
      {"a.pcd", pcd("WIDTH\nHEIGHT 1\nDATA ascii\n1 2 3\n")},
      {"a.ptx", "1\n1\n \n \n"},
      {"a.obj", "v\nf\n"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf / / /\n"},
      {"a.off", "OFF\n  \n"},
      {"a.off", "OFF\n3 1\n"},
      {"a.stl", "solid\nfacet\n"},
      {"a.csv", ",,\n,,\n"},
      {"a.3d", "\n \n"},
  });
}

TEST(BugClasses, AMatrixThatIsNoneStopsTheScan) {
  const auto with_row = [](const std::string& row) {
    return "1\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + row + "\n0 1 0 0\n0 0 1 0\n0 0 0 1\n1 2 3\n";
  };
  expect_refused({
      {"a.ptx", with_row("1 0 x 0")},
      {"a.ptx", with_row("1 0 0")},
      {"a.ptx", with_row("nan 0 0 0")},
      {"a.ptx", with_row("0 0 0 0")},
      {"a.e57", e57([](auto& scan) {
         scan.xml =
             "<pose type=\"Structure\"><rotation type=\"Structure\"><w "
             "type=\"Float\">x</w></rotation></pose>";
       })},
  });
}

TEST(BugClasses, AnStlIsBinaryByItsSizeWhateverItsFirstWord) {
  std::string bytes = "solid model" + zeros(69) + raw(1U, false) + zeros(50);
  const float one = 1;
  std::memcpy(bytes.data() + 84 + 24, &one, 4);
  std::memcpy(bytes.data() + 84 + 40, &one, 4);
  EXPECT_EQ(io::parse_scans("a.stl", bytes).at(0).cloud.size(), 3U);
}

TEST(BugClasses, PosesNameFilesByTheirLastPartAlone) {
  const test::ScratchFolder folder;
  write_file(folder / "a.aln", "1\n../../etc/one.ply\n#\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n0\n");
  EXPECT_EQ(io::read_scan_poses(folder / "a.aln").count("one.ply"), 1U);
}

}  // namespace
}  // namespace drape
