// 3DTK's scans: scanNNN.3d with points, beside it scanNNN.frames or scanNNN.pose with where it was taken.
//
// 3DTK's frame is left-handed: x right, y up, z ahead, in centimetres where its own converters wrote it.
// Points and poses are turned to a right-handed frame with z up: (x, y, z) -> (z, -x, y), the inverse of what
// those converters do.
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <filesystem>

#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "rigid_part.hpp"
#include "scan_builder.hpp"
#include "scan_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

const Eigen::Matrix3d& right_from_left() {
  static const Eigen::Matrix3d matrix = (Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, 1, 0).finished();
  return matrix;
}

Rigid3 turned(const Eigen::Matrix4d& left) {
  Eigen::Matrix4d right = Eigen::Matrix4d::Identity();
  right.topLeftCorner<3, 3>() =
      right_from_left() * left.topLeftCorner<3, 3>() * right_from_left().transpose();
  right.topRightCorner<3, 1>() = right_from_left() * left.topRightCorner<3, 1>();
  return nearest_rigid(right);
}

template <std::size_t count>
std::array<double, count> numbers(const std::string& file, const TextLines& lines, Words& words) {
  std::array<double, count> values{};
  for (double& value : values) {
    const auto number = parse_value(words.next());
    if (!number || !std::isfinite(*number))
      throw line_error(file, lines.number(), "{} numbers are expected", count);
    value = *number;
  }
  return values;
}

/// One line per step of the registration: 16 numbers of a matrix, column by column, and a tag. The last
/// counts.
Rigid3 read_frames(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  TextLines lines(bytes);
  std::optional<Rigid3> pose;
  while (lines.next_filled()) {
    Words words(lines.line());
    const Eigen::Matrix4d matrix(numbers<16>(file, lines, words).data());
    if (!is_rotation(matrix.topLeftCorner<3, 3>(), 1e-3))
      throw line_error(file, lines.number(), "the matrix is no rigid motion");
    pose = turned(matrix);
  }
  if (!pose) throw input_error("{}: holds no frame", file);
  return *pose;
}

/// Place, then angles about x, y and z in degrees: 3DTK's EulerToMatrix4, in its left-handed frame.
Rigid3 read_pose(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  TextLines lines(bytes);
  std::array<double, 6> n{};
  for (std::size_t half = 0; half < 2; ++half) {
    if (!lines.next_filled()) throw line_error(file, lines.number(), "a pose has two lines of three numbers");
    Words words(lines.line());
    const auto three = numbers<3>(file, lines, words);
    std::copy(three.begin(), three.end(), n.begin() + static_cast<std::ptrdiff_t>(3 * half));
  }
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  const auto about = [&](std::size_t axis) {
    return Eigen::AngleAxisd(n[3 + axis] * M_PI / 180, Eigen::Vector3d::Unit(static_cast<Eigen::Index>(axis)))
        .toRotationMatrix();
  };
  matrix.topLeftCorner<3, 3>() = about(0) * about(1) * about(2);
  matrix.topRightCorner<3, 1>() = Eigen::Vector3d(n.data());
  return turned(matrix);
}

}  // namespace

std::vector<RangeScan> read_3dtk_scan(const ScanSource& source) {
  TextLines lines(source.bytes);
  std::optional<ScanBuilder> builder;
  std::size_t width = 0;
  std::array<double, 7> values{};
  while (lines.next_filled()) {
    Words words(lines.line());
    std::size_t count = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const auto value = parse_value(word);
      // The first line may state the scan's resolution: "181 x 361".
      if (!value && !builder) break;
      if (!value) throw line_error(source.file, lines.number(), "{} is no number", shown(word));
      if (count == values.size()) throw line_error(source.file, lines.number(), "more than 7 numbers");
      values[count++] = *value;
    }
    if (!builder && count < 3 && lines.number() == 1) continue;
    if (!builder) {
      width = count;
      builder.emplace(source.file,
                      SampleFields{.colors = width >= 6, .intensities = width == 4 || width == 7},
                      source.options.most_points);
    }
    if (count != width || width < 3 || width == 5)
      throw line_error(source.file, lines.number(),
                       "has {} numbers; a point has 3, 4 (reflectance), 6 or 7 (colour)", count);
    Sample sample;
    sample.position = right_from_left() * Eigen::Vector3d(values.data());
    sample.intensity = values[3];
    sample.color = Eigen::Vector3d(values.data() + width - 3);
    builder->add(sample);
  }
  if (!builder) throw input_error("{}: holds no point", source.file);
  if (!lines.ended()) log::warn("{}: the last line has no line end: the file may be truncated", source.file);
  RangeScan scan = builder->finish();
  scan.view = {ScanView::Kind::origin, Eigen::Vector3d::Zero()};
  std::filesystem::path beside = source.file;
  if (std::filesystem::exists(beside.replace_extension(".frames")))
    scan.world_from_scan = read_frames(beside);
  else if (std::filesystem::exists(beside.replace_extension(".pose")))
    scan.world_from_scan = read_pose(beside);
  return {std::move(scan)};
}

}  // namespace drape::io
