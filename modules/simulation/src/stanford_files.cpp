#include "stanford_files.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"

namespace drape::simulation {
namespace {

void put_int(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(value >> shift & 0xff));
}
void put_float(std::string& bytes, double value) {
  put_int(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}

std::string header(const RangeScan& scan, double metres_per_unit) {
  const Eigen::Vector3d& v = scan.view.vector;
  const double unit = scan.view.kind == ScanView::Kind::origin ? metres_per_unit : 1;
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  if (scan.view.kind != ScanView::Kind::unknown)
    text += fmt::format(
        "obj_info {} {} {} {}\n", scan.view.kind == ScanView::Kind::origin ? "view_origin" : "view_direction",
        format_number(v.x() / unit), format_number(v.y() / unit), format_number(v.z() / unit));
  if (scan.grid)
    text += fmt::format("obj_info num_cols {}\nobj_info num_rows {}\n", scan.grid->columns, scan.grid->rows);
  text += fmt::format("element vertex {}\nproperty float x\nproperty float y\nproperty float z\n",
                      scan.cloud.size());
  if (!scan.cloud.intensities.empty()) text += "property float intensity\n";
  if (!scan.cloud.colors.empty()) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (scan.grid)
    text += fmt::format("element range_grid {}\nproperty list uchar int vertex_indices\n",
                        scan.grid->cells.size());
  return text + "end_header\n";
}

}  // namespace

void write_range_ply(const std::filesystem::path& file, const RangeScan& scan, double metres_per_unit) {
  std::string bytes = header(scan, metres_per_unit);
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    for (const double coordinate : scan.cloud.positions[i]) put_float(bytes, coordinate / metres_per_unit);
    if (!scan.cloud.intensities.empty()) put_float(bytes, scan.cloud.intensities[i]);
    if (!scan.cloud.colors.empty())
      for (const float channel : scan.cloud.colors[i])
        bytes.push_back(static_cast<char>(std::lround(255 * channel)));
  }
  if (scan.grid)
    for (const std::int32_t cell : scan.grid->cells) {
      bytes.push_back(cell == RangeGrid::missing ? '\0' : '\1');
      if (cell != RangeGrid::missing) put_int(bytes, static_cast<std::uint32_t>(cell));
    }
  write_file(file, bytes);
}

void write_stanford_conf(const std::filesystem::path& file, const std::vector<NamedPose>& poses,
                         double metres_per_unit) {
  std::string text;
  for (const NamedPose& pose : poses) {
    const Eigen::Vector3d t = pose.world_from_scan.translation() / metres_per_unit;
    // The format's quaternion is that of the transposed rotation.
    const Eigen::Quaterniond q(Eigen::Matrix3d(pose.world_from_scan.linear().transpose()));
    text += fmt::format("bmesh {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", pose.scan, t.x(),
                        t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  write_file(file, text);
}

}  // namespace drape::simulation
