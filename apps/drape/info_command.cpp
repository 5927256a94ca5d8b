#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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

// Median distance to the nearest other point of the same run of a sample. Nothing where the points of the
// file follow each other in no order of space: then half a run holds neighbours that are further apart.
std::optional<double> spacing_along(const std::vector<Eigen::Vector3d>& points, std::size_t run) {
  constexpr std::size_t runs_asked = 64;
  const std::size_t count = points.size() / run;
  const auto nearest_within = [&](std::size_t length) {
    std::vector<double> distances;
    for (std::size_t r = 0; r < count; r += std::max<std::size_t>(1, count / runs_asked))
      for (std::size_t i = 0; i < length; ++i) {
        double squared = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < length; ++j)
          if (i != j) squared = std::min(squared, (points[r * run + i] - points[r * run + j]).squaredNorm());
        distances.push_back(std::sqrt(squared));
      }
    const auto median = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), median, distances.end());
    return *median;
  };
  if (count == 0) return std::nullopt;
  const double whole = nearest_within(run);
  constexpr double in_order = 1.2;  // without an order: sqrt(2) on a surface
  return nearest_within(run / 2) < in_order * whole ? std::optional(whole) : std::nullopt;
}

bool is_photo(const std::filesystem::path& file) {
  static constexpr std::array<std::string_view, 10> endings{"jpg",  "jpeg", "png", "tif", "tiff",
                                                            "webp", "bmp",  "ppm", "pgm", "pnm"};
  return std::find(endings.begin(), endings.end(), extension(file)) != endings.end();
}

void print_view_and_pose(const RangeScan& scan) {
  if (scan.view.kind == ScanView::Kind::origin)
    fmt::print("  scanner  at {}\n", vector_text(scan.view.vector));
  if (scan.view.kind == ScanView::Kind::direction)
    fmt::print("  scanner  parallel rays along {}\n", vector_text(scan.view.vector));
  if (scan.world_from_scan) {
    if (scan.world_from_scan->isApprox(Rigid3::Identity())) {
      fmt::print("  pose     the identity\n");
      return;
    }
    const Eigen::AngleAxisd turn(scan.world_from_scan->linear());
    fmt::print("  pose     moved by {}, turned by {:.4g} degrees about {}\n",
               vector_text(scan.world_from_scan->translation()), turn.angle() * 180 / M_PI,
               vector_text(turn.axis()));
  }
}

void print_box(const BoundingBox& box, const char* how) {
  fmt::print("  box      {} to {}, diagonal {:.6g}{}\n", vector_text(box.min()), vector_text(box.max()),
             box.diagonal().norm(), how);
}

void print_scan(const RangeScan& scan, std::size_t of) {
  if (of > 1) fmt::print("  scan {} of {}\n", scan.index_in_file + 1, of);
  fmt::print("  points   {} ({})\n", scan.cloud.size(), fields_of(scan.cloud));
  if (scan.grid) fmt::print("  grid     {} rows, {} columns\n", scan.grid->rows, scan.grid->columns);
  if (!scan.cloud.empty()) {
    print_box(bounding_box(scan.cloud.positions), "");
    fmt::print("  spacing  {:.4g}\n", spacing_of(scan.cloud.positions));
  }
  print_view_and_pose(scan);
}

// A large file, by its header and a part of its points.
void print_sample(const std::filesystem::path& file, const io::ScanSample& sample) {
  const PointCloud& cloud = sample.scan.cloud;
  fmt::print("{}: {}, 1 scan; told from the header and {} points all over the file\n", file.string(),
             io::scan_format(file).name, cloud.size());
  fmt::print("  points   {} ({})\n", sample.points, fields_of(cloud));
  if (sample.rows > 0) fmt::print("  grid     {} rows, {} columns\n", sample.rows, sample.columns);
  if (sample.stated_box)
    print_box(*sample.stated_box, ", by the header");
  else
    print_box(bounding_box(cloud.positions), ", of the sample");
  if (const auto spacing = spacing_along(cloud.positions, sample.run_points))
    fmt::print("  spacing  {:.4g}, along the points as they follow each other\n", *spacing);
  else
    fmt::print("  spacing  a sample cannot tell: the points follow each other in no order of space\n");
  print_view_and_pose(sample.scan);
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
    if (std::filesystem::is_regular_file(file) && std::filesystem::file_size(file) == 0)
      throw input_error("{}: is empty", file.string());
    if (io::is_pose_file(file)) {
      print_poses(file);
      continue;
    }
    if (is_photo(file)) {
      print_photo(file);
      continue;
    }
    if (const std::optional<io::ScanSample> sample = io::sample_scan(file)) {
      print_sample(file, *sample);
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
    if (const std::size_t photos = io::count_embedded_photos(file); photos > 0)
      fmt::print("  photos   {}\n", photos);
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
