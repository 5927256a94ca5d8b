#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/scan_files.hpp"
#include "mesh_info.hpp"

namespace drape::app {
namespace {

std::string vector_text(const Eigen::Vector3d& v) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x(), v.y(), v.z());
}

std::string fields_of(const PointCloud& cloud) {
  std::string text = "x y z";
  if (!cloud.normals.empty()) text += ", normals";
  if (!cloud.colors.empty()) text += ", colour";
  if (!cloud.intensities.empty()) text += ", intensity";
  if (!cloud.confidences.empty()) text += ", confidence";
  return text;
}

// Median distance to the nearest other point, of the points round the middle one of the file: all of a small
// scan.
double spacing_of(std::vector<Eigen::Vector3d> points) {
  constexpr std::size_t most = 50'000;
  constexpr std::size_t most_asked = 500;
  if (points.size() < 2) return 0;
  const Eigen::Vector3d middle = points[points.size() / 2];
  const auto nearer = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - middle).squaredNorm() < (b - middle).squaredNorm();
  };
  if (points.size() > most) {
    std::nth_element(points.begin(), points.begin() + most, points.end(), nearer);
    points.resize(most);
  }
  const std::size_t asked = std::min(most_asked, points.size());
  std::partial_sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(asked), points.end(),
                    nearer);
  const KdTree tree(points);
  std::vector<double> distances;
  for (std::size_t i = 0; i < asked; ++i)
    distances.push_back(std::sqrt(tree.nearest(points[i], 2).back().squared_distance));
  const auto median = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), median, distances.end());
  return *median;
}

bool is_photo(const std::filesystem::path& file) {
  static constexpr std::array<std::string_view, 10> endings{"jpg",  "jpeg", "png", "tif", "tiff",
                                                            "webp", "bmp",  "ppm", "pgm", "pnm"};
  return std::find(endings.begin(), endings.end(), extension(file)) != endings.end();
}

void print_scan(const RangeScan& scan, std::size_t of) {
  if (of > 1) fmt::print("  scan {} of {}\n", scan.index_in_file + 1, of);
  fmt::print("  points   {} ({})\n", scan.cloud.size(), fields_of(scan.cloud));
  if (scan.grid) fmt::print("  grid     {} rows, {} columns\n", scan.grid->rows, scan.grid->columns);
  if (scan.cloud.empty()) return;
  const BoundingBox box = bounding_box(scan.cloud.positions);
  fmt::print("  box      {} to {}, diagonal {:.6g}\n", vector_text(box.min()), vector_text(box.max()),
             box.diagonal().norm());
  fmt::print("  spacing  {:.4g}\n", spacing_of(scan.cloud.positions));
  if (scan.view.kind == ScanView::Kind::origin)
    fmt::print("  scanner  at {}\n", vector_text(scan.view.vector));
  if (scan.view.kind == ScanView::Kind::direction)
    fmt::print("  scanner  parallel rays along {}\n", vector_text(scan.view.vector));
  if (scan.world_from_scan) {
    const Eigen::AngleAxisd turn(scan.world_from_scan->linear());
    fmt::print("  pose     moved by {}, turned by {:.4g} degrees about {}\n",
               vector_text(scan.world_from_scan->translation()), turn.angle() * 180 / M_PI,
               vector_text(turn.axis()));
  }
}

void print_photo(const std::filesystem::path& file) {
  const io::Photo photo = io::read_photo(file);
  fmt::print("{}: photo, {} x {} pixels", file.string(), photo.rgb.width(), photo.rgb.height());
  if (photo.focal_px_prior) fmt::print(", focal length {:.0f} px by EXIF", *photo.focal_px_prior);
  if (!photo.camera_model.empty()) fmt::print(", {}", photo.camera_model);
  fmt::print("\n");
}

void print_poses(const std::filesystem::path& file) {
  const auto poses = io::read_scan_poses(file);
  fmt::print("{}: poses of {} scans\n", file.string(), poses.size());
  for (const auto& [scan, pose] : poses) fmt::print("  {} at {}\n", scan, vector_text(pose.translation()));
}

}  // namespace

void info_command(const InfoArguments& arguments) {
  constexpr std::size_t most_shown = 6;
  for (const std::filesystem::path& file : arguments.files) {
    if (io::is_pose_file(file)) {
      print_poses(file);
      continue;
    }
    if (is_photo(file)) {
      print_photo(file);
      continue;
    }
    if (const std::optional<TriangleMesh> mesh = mesh_in(file)) {
      print_mesh_info(file, *mesh);
      continue;
    }
    const io::ScanFormatFacts format = io::scan_format(file);
    const std::vector<RangeScan> scans = io::read_scans(file);
    fmt::print("{}: {}, {} scan{}\n", file.string(), format.name, scans.size(), scans.size() == 1 ? "" : "s");
    for (std::size_t i = 0; i < std::min(scans.size(), most_shown); ++i) print_scan(scans[i], scans.size());
    if (scans.size() > most_shown) fmt::print("  ... {} more\n", scans.size() - most_shown);
  }
}

void convert_command(const ConvertArguments& arguments) {
  const std::vector<RangeScan> scans = io::read_scans(arguments.input);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    std::filesystem::path output = arguments.output;
    if (scans.size() > 1)  // scan.xyz -> scan-1.xyz, scan-2.xyz, ...
      output.replace_filename(
          fmt::format("{}-{}{}", output.stem().string(), i + 1, output.extension().string()));
    io::write_scan(output, scans[i]);
    fmt::print("{}: {} points\n", output.string(), scans[i].cloud.size());
  }
}

}  // namespace drape::app
