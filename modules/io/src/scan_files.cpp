#include "drape/io/scan_files.hpp"

#include <array>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "mesh_formats.hpp"
#include "scan_formats.hpp"

namespace drape::io {
namespace {

bool looks_like_ply(std::string_view bytes) {
  return bytes.size() > 3 && bytes.starts_with("ply") &&
         (bytes[3] == '\n' || bytes[3] == '\r' || bytes[3] == ' ');
}

bool looks_like_pcd(std::string_view bytes) {
  return bytes.starts_with("# .PCD") || bytes.starts_with("VERSION") || bytes.starts_with("FIELDS");
}
bool no_signature(std::string_view) {
  return false;
}

struct ScanFormat {
  ScanFormatFacts facts;
  bool (*recognises)(std::string_view bytes);
  ScanReader read;
};

// The one table of scan formats. Content counts before the extension: the first that recognises the bytes,
// else the one of the extension.
constexpr std::array<ScanFormat, 11> formats{{
    {{"PLY", "ply", "ASCII, binary of both byte orders; any further elements and properties are stepped over",
      "normals, colour, intensity, confidence, Stanford range_grid, camera position", true},
     looks_like_ply,
     read_ply_scan},
    {{"PCD", "pcd", "ascii, binary, binary_compressed",
      "normals, colour, intensity, grid (organised), viewpoint", true},
     looks_like_pcd,
     read_pcd_scan},
    {{"E57", "e57", "Cartesian and spherical; float, scaled and plain integers; checksums are checked",
      "normals, colour, intensity, grid, pose of each scan; photos come out as photos/NNN.png", false},
     looks_like_e57,
     read_e57_scan},
    {{"LAS", "las laz", "1.0 to 1.4, point formats 0 to 10; LAZ is refused with the name of a converter",
      "colour, intensity", false},
     looks_like_las,
     read_las_scan},
    {{"PTX", "ptx", "any number of scans in a file",
      "normals, colour, intensity, grid, pose, scanner position", false},
     no_signature,
     read_ptx_scan},
    {{"text", "xyz txt csv asc pts xyzn xyzrgb",
      "separator, decimal comma, header and columns are found, or columns stated by input.columns; PTS",
      "normals, colour, intensity, confidence", true},
     no_signature,
     read_xyz_scan},
    {{"3DTK", "3d",
      ".3d with its .frames or .pose beside it; turned from left-handed to right-handed with z up",
      "colour, reflectance, pose, scanner position", false},
     no_signature,
     read_3dtk_scan},
    {{"depth picture", "png tif tiff exr",
      "16-bit or float, with input.depth; OpenEXR's channel Z, V, Y or R", "grid, camera position", false},
     no_signature,
     read_depth_scan},
    {{"OBJ", "obj", "the vertices", "normals, colour", false}, no_signature, read_mesh_scan},
    {{"STL", "stl", "the corners, once each", "", false}, no_signature, read_mesh_scan},
    {{"OFF", "off", "the vertices", "normals, colour", false}, looks_like_off, read_mesh_scan},
}};

bool has_extension(const ScanFormatFacts& facts, std::string_view ending) {
  std::string_view rest = facts.extensions;
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ');
    if (rest.substr(0, end) == ending) return true;
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return false;
}

const ScanFormat& format_of(const std::filesystem::path& file, std::string_view bytes) {
  for (const ScanFormat& format : formats)
    if (format.recognises(bytes)) return format;
  const std::string ending = extension(file);
  std::string known;
  for (const ScanFormat& format : formats) {
    if (has_extension(format.facts, ending)) return format;
    known += (known.empty() ? "" : " ") + std::string(format.facts.extensions);
  }
  throw input_error("{}: is no scan format that can be read ({})", file.string(), known);
}

template <class Attribute>
void keep(std::vector<Attribute>& values, const std::vector<std::int32_t>& renamed) {
  if (values.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (renamed[i] != RangeGrid::missing) values[kept++] = values[i];
  values.resize(kept);
}

}  // namespace

RangeScan without_bad_points(RangeScan scan) {
  std::vector<std::int32_t> renamed(scan.cloud.size(), RangeGrid::missing);
  std::int32_t next = 0;
  for (std::size_t i = 0; i < renamed.size(); ++i)
    if (scan.cloud.positions[i].allFinite()) renamed[i] = next++;
  if (static_cast<std::size_t>(next) == renamed.size()) return scan;
  keep(scan.cloud.positions, renamed);
  keep(scan.cloud.normals, renamed);
  keep(scan.cloud.colors, renamed);
  keep(scan.cloud.intensities, renamed);
  keep(scan.cloud.confidences, renamed);
  if (scan.grid)
    for (std::int32_t& cell : scan.grid->cells)
      if (cell != RangeGrid::missing) cell = renamed[static_cast<std::size_t>(cell)];
  return scan;
}

std::vector<ScanFormatFacts> scan_format_facts() {
  std::vector<ScanFormatFacts> facts;
  for (const ScanFormat& format : formats) facts.push_back(format.facts);
  return facts;
}

ScanFormatFacts scan_format(const std::filesystem::path& file) {
  const FileBytes bytes(file);
  return format_of(file, bytes.view()).facts;
}

std::vector<RangeScan> parse_scans(const std::filesystem::path& file, std::string_view bytes,
                                   const ScanReadOptions& options) {
  if (bytes.empty()) throw input_error("{}: is empty", file.string());
  const std::string name = file.string();
  std::vector<RangeScan> scans = format_of(file, bytes).read({name, bytes, options});
  std::size_t points = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i] = without_bad_points(std::move(scans[i]));
    points += scans[i].cloud.size();
    scans[i].file = file.filename().string();
    scans[i].index_in_file = static_cast<int>(i);
  }
  if (points == 0) throw input_error("{}: holds no point", file.string());
  return scans;
}

std::vector<RangeScan> read_scans(const std::filesystem::path& file, const ScanReadOptions& options) {
  return parse_scans(file, FileBytes(file).view(), options);
}

}  // namespace drape::io
