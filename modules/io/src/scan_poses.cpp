// Files that hold the poses of scans.
#include <algorithm>
#include <array>
#include <cmath>
#include <pugixml.hpp>

#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/io/scan_files.hpp"
#include "rigid_part.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

using Poses = std::map<std::string, Rigid3>;

std::string base_name(std::string_view name) {
  const std::size_t slash = name.find_last_of("/\\");  // MeshLab on Windows writes backslashes
  return std::string(slash == std::string_view::npos ? name : name.substr(slash + 1));
}

/// `bmesh file tx ty tz qx qy qz qw`; p_world = R(q)^T p_scan + t.
Poses parse_stanford_conf(const std::string& file, std::string_view bytes) {
  Poses poses;
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

/// Sixteen numbers row by row, of which `words` gives as many as it has.
bool take_numbers(const std::string& file, std::size_t line, Words words, Eigen::Matrix4d& matrix,
                  Eigen::Index& count) {
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const auto value = parse_value(word);
    if (!value || !std::isfinite(*value)) throw line_error(file, line, "{} is no number", shown(word));
    if (count == 16) throw line_error(file, line, "more than sixteen numbers of a matrix");
    matrix(count / 4, count % 4) = *value;
    ++count;
  }
  return count == 16;
}

void add_pose(Poses& poses, const std::string& file, std::size_t line, const std::string& scan,
              const Eigen::Matrix4d& matrix) {
  if (!is_rotation(matrix.topLeftCorner<3, 3>(), 1e-3) ||
      !matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-6))
    throw line_error(file, line, "the matrix of {} is no rigid motion", shown(scan));
  if (!poses.emplace(scan, nearest_rigid(matrix)).second)
    throw line_error(file, line, "{} has a pose already", shown(scan));
}

/// MeshLab's .aln: the number of scans; for each its file, a line "#", and four lines of a matrix; then 0.
Poses parse_aln(const std::string& file, std::string_view bytes) {
  Poses poses;
  TextLines lines(bytes);
  const auto next = [&] {
    if (!lines.next_filled()) throw line_error(file, lines.number(), "the file ends before its last scan");
  };
  next();
  const auto count = parse_integer(Words(lines.line()).next());
  if (!count || *count < 1 || *count > 1'000'000)
    throw line_error(file, lines.number(), "{} is no number of scans", shown(lines.line()));
  for (std::int64_t i = 0; i < *count; ++i) {
    next();
    const std::string scan = base_name(Words(lines.line()).next());
    const std::size_t line = lines.number();
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    Eigen::Index numbers = 0;
    do {
      next();
    } while (lines.line().starts_with('#') ||
             !take_numbers(file, lines.number(), Words(lines.line()), matrix, numbers));
    add_pose(poses, file, line, scan, matrix);
  }
  return poses;
}

/// MeshLab's project: MLMesh elements with a filename and an MLMatrix44.
Poses parse_mlp(const std::string& file, std::string_view bytes) {
  pugi::xml_document document;
  if (const auto result = document.load_buffer(bytes.data(), bytes.size()); !result)
    throw byte_error(file, static_cast<std::uint64_t>(result.offset), "the XML is damaged: {}",
                     result.description());
  Poses poses;
  for (const pugi::xml_node mesh : document.child("MeshLabProject").child("MeshGroup").children("MLMesh")) {
    const auto place = static_cast<std::size_t>(mesh.offset_debug());
    const std::size_t line =
        1 +
        static_cast<std::size_t>(std::count(
            bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min(place, bytes.size())), '\n'));
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
    Eigen::Index numbers = 0;
    TextLines lines(mesh.child("MLMatrix44").text().get());
    while (lines.next_filled()) take_numbers(file, line, Words(lines.line()), matrix, numbers);
    if (numbers != 0 && numbers != 16)
      throw line_error(file, line, "a matrix has sixteen numbers, not {}", numbers);
    add_pose(poses, file, line, base_name(mesh.attribute("filename").value()), matrix);
  }
  if (poses.empty()) throw input_error("{}: holds no MLMesh with a matrix", file);
  return poses;
}

struct PoseFormat {
  std::string_view extension;
  Poses (*parse)(const std::string& file, std::string_view bytes);
};
constexpr std::array<PoseFormat, 3> formats{
    {{"conf", parse_stanford_conf}, {"aln", parse_aln}, {"mlp", parse_mlp}}};

}  // namespace

bool is_pose_file(const std::filesystem::path& file) {
  const std::string ending = extension(file);
  return std::any_of(formats.begin(), formats.end(),
                     [&](const PoseFormat& format) { return format.extension == ending; });
}

std::map<std::string, Rigid3> read_scan_poses(const std::filesystem::path& file) {
  const std::string ending = extension(file);
  for (const PoseFormat& format : formats)
    if (format.extension == ending) return format.parse(file.string(), read_file(file));
  throw input_error("{}: is no file of poses that can be read (.conf, .aln, .mlp)", file.string());
}

}  // namespace drape::io
