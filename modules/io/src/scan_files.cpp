#include "drape/io/scan_files.hpp"

#include <array>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
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
  std::string_view extension;
  bool (*recognises)(std::string_view bytes);
  ScanReader read;
};

// Content counts before the extension: the first that recognises the bytes, else the one of the extension.
constexpr std::array<ScanFormat, 8> formats{{
    {"ply", looks_like_ply, read_ply_scan},
    {"pcd", looks_like_pcd, read_pcd_scan},
    {"xyz", no_signature, read_xyz_scan},
    {"txt", no_signature, read_xyz_scan},
    {"csv", no_signature, read_xyz_scan},
    {"asc", no_signature, read_xyz_scan},
    {"xyzn", no_signature, read_xyz_scan},
    {"xyzrgb", no_signature, read_xyz_scan},
}};

const ScanFormat& format_of(const std::filesystem::path& file, std::string_view bytes) {
  for (const ScanFormat& format : formats)
    if (format.recognises(bytes)) return format;
  const std::string ending = extension(file);
  std::string known;
  for (const ScanFormat& format : formats) {
    if (format.extension == ending) return format;
    known += (known.empty() ? "" : ", ") + std::string(format.extension);
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

std::vector<RangeScan> read_scans(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  if (bytes.empty()) throw input_error("{}: is empty", file.string());
  std::vector<RangeScan> scans = format_of(file, bytes).read(file.string(), bytes);
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

}  // namespace drape::io
