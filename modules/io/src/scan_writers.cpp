// Scans as other programs read them.
#include <algorithm>
#include <cmath>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/io/scan_files.hpp"

namespace drape::io {
namespace {

std::uint32_t byte_of(float value) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 255.0F));
}

/// Blanks between, one point a line, named by a header line.
std::string text_of(const PointCloud& cloud, char separator) {
  std::string text = separator == ',' ? "x" : "# x";
  const auto name = [&](std::string_view word) { (text += separator) += word; };
  name("y"), name("z");
  if (!cloud.normals.empty()) name("nx"), name("ny"), name("nz");
  if (!cloud.colors.empty()) name("red"), name("green"), name("blue");
  if (!cloud.intensities.empty()) name("intensity");
  text += '\n';
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d& p = cloud.positions[i];
    text += format_number(p.x());
    name(format_number(p.y())), name(format_number(p.z()));
    if (!cloud.normals.empty())
      for (const float value : cloud.normals[i]) name(format_number(value));
    if (!cloud.colors.empty())
      for (const float value : cloud.colors[i]) name(std::to_string(byte_of(value)));
    if (!cloud.intensities.empty()) name(format_number(cloud.intensities[i]));
    text += '\n';
  }
  return text;
}

template <class Number>
void put(std::string& bytes, Number value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Binary, positions as doubles (PCL itself reads those as floats); organised where there is a grid.
std::string pcd_of(const RangeScan& scan) {
  const PointCloud& cloud = scan.cloud;
  const std::size_t width = scan.grid ? static_cast<std::size_t>(scan.grid->columns) : cloud.size();
  const std::size_t height = scan.grid ? static_cast<std::size_t>(scan.grid->rows) : 1;
  std::string fields = "x y z", sizes = "8 8 8", types = "F F F", counts = "1 1 1";
  const auto field = [&](const char* name, const char* type) {
    (fields += ' ') += name, sizes += " 4", (types += ' ') += type, counts += " 1";
  };
  if (!cloud.normals.empty()) field("normal_x", "F"), field("normal_y", "F"), field("normal_z", "F");
  if (!cloud.colors.empty()) field("rgb", "U");
  if (!cloud.intensities.empty()) field("intensity", "F");
  const Eigen::Vector3d origin =
      scan.view.kind == ScanView::Kind::origin ? scan.view.vector : Eigen::Vector3d(Eigen::Vector3d::Zero());
  std::string bytes = fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\nWIDTH "
      "{}\nHEIGHT "
      "{}\nVIEWPOINT {} {} {} 1 0 0 0\nPOINTS {}\nDATA binary\n",
      fields, sizes, types, counts, width, height, format_number(origin.x()), format_number(origin.y()),
      format_number(origin.z()), width * height);
  for (std::size_t cell = 0; cell < width * height; ++cell) {
    const std::int64_t i = scan.grid ? scan.grid->cells[cell] : static_cast<std::int64_t>(cell);
    const bool there = i >= 0;
    const auto at = static_cast<std::size_t>(i);
    for (int k = 0; k < 3; ++k) put(bytes, there ? cloud.positions[at][k] : std::nan(""));
    if (!cloud.normals.empty())
      for (int k = 0; k < 3; ++k) put(bytes, there ? cloud.normals[at][k] : std::nanf(""));
    if (!cloud.colors.empty()) {
      const Eigen::Vector3f color = there ? cloud.colors[at] : Eigen::Vector3f(0, 0, 0);
      put(bytes, byte_of(color.x()) << 16 | byte_of(color.y()) << 8 | byte_of(color.z()));
    }
    if (!cloud.intensities.empty()) put(bytes, there ? cloud.intensities[at] : 0.0F);
  }
  return bytes;
}

}  // namespace

void write_scan(const std::filesystem::path& file, const RangeScan& scan) {
  const std::string ending = extension(file);
  if (ending == "ply") return write_scan_ply(file, scan);
  if (ending == "pcd") return write_file(file, pcd_of(scan));
  if (ending == "csv") return write_file(file, text_of(scan.cloud, ','));
  if (ending == "xyz" || ending == "txt" || ending == "asc")
    return write_file(file, text_of(scan.cloud, ' '));
  throw config_error("{}: scans are written as .ply, .pcd, .xyz, .txt, .asc or .csv", file.string());
}

}  // namespace drape::io
