#include <array>
#include <cmath>

#include "drape/base/files.hpp"
#include "drape/io/scan_files.hpp"
#include "text_lines.hpp"

namespace drape::io {

std::map<std::string, Rigid3> read_stanford_conf(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  std::map<std::string, Rigid3> poses;
  TextLines lines(bytes);
  while (lines.next_filled()) {
    Words words(lines.line());
    const std::string_view key = words.next();
    if (key.starts_with('#') || key == "camera" || key == "mesh") continue;
    if (key != "bmesh")
      throw line_error(file, lines.number(),
                       "unknown line {}: \"bmesh file tx ty tz qx qy qz qw\" is expected",
                       shown(lines.line()));
    const std::string name = std::filesystem::path(words.next()).filename().string();
    std::array<double, 7> n{};
    for (double& number : n) {
      const auto value = parse_value(words.next());
      if (!value || !std::isfinite(*value))
        throw line_error(file, lines.number(), "a pose needs seven numbers: tx ty tz qx qy qz qw");
      number = *value;
    }
    if (!words.rest().empty()) throw line_error(file, lines.number(), "more than seven numbers");
    const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
    if (!(q.norm() > 0.5 && q.norm() < 2))
      throw line_error(file, lines.number(), "the quaternion has length {}, not 1", q.norm());
    Rigid3 world_from_scan = Rigid3::Identity();
    world_from_scan.linear() = q.normalized().toRotationMatrix().transpose();
    world_from_scan.translation() = Eigen::Vector3d(n[0], n[1], n[2]);
    if (!poses.emplace(name, world_from_scan).second)
      throw line_error(file, lines.number(), "{} has a pose already", shown(name));
  }
  if (poses.empty())
    throw input_error("{}: holds no pose (a line \"bmesh file tx ty tz qx qy qz qw\")", file);
  return poses;
}

}  // namespace drape::io
