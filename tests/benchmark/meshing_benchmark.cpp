// What meshing costs: CPU seconds and peak memory of the bunny's raw scans and of simulated scans of growing
// size; and what filling and simplifying cost. File reading apart.
// Usage: meshing_benchmark [bunny] [filling] [POINTS ...]   (default: bunny filling 360000 3600000; in full:
// also 10000000 36000000, which take 2 GB and 7 GB)
#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "drape/base/random.hpp"
#include "drape/ingest/point_spacing.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/meshing/hole_filling.hpp"
#include "drape/meshing/mesh_scans.hpp"
#include "drape/meshing/simplify.hpp"
#include "support.hpp"

namespace drape {
namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// From now on the peak is counted anew.
void reset_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << "5";
}

double status_megabytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with(key + ":")) return std::stod(line.substr(key.size() + 1)) / 1024;
  return 0;
}

struct Scans {
  std::vector<RangeScan> scans;
  std::vector<Rigid3> world_from_scan;
  double spacing = 0;

  [[nodiscard]] std::size_t points() const {
    std::size_t sum = 0;
    for (const RangeScan& scan : scans) sum += scan.cloud.size();
    return sum;
  }
};

Scans bunny() {
  Scans all;
  const auto poses = io::read_scan_poses(test::data("scans/bunny/bun.conf"));
  for (const auto& [file, world_from_scan] : poses) {
    all.scans.push_back(io::read_scans(test::data("scans/bunny/" + file)).front());
    all.world_from_scan.push_back(world_from_scan);
    all.spacing += ingest::point_spacing(all.scans.back()) / static_cast<double>(poses.size());
  }
  return all;
}

// A sphere of radius 1, seen along six axes on square lattices, with noise of a third of the spacing.
Scans sphere_scans(std::size_t points) {
  Scans all;
  const int side = static_cast<int>(std::sqrt(static_cast<double>(points) / 6 * 4 / std::numbers::pi));
  all.spacing = 2.0 / side;
  for (int k = 0; k < 6; ++k) {
    RangeScan scan;
    scan.file = fmt::format("sphere {}", k);
    scan.view = {ScanView::Kind::direction, Eigen::Vector3d::UnitZ()};
    scan.spacing = all.spacing;
    scan.grid = RangeGrid{side, side, {}};
    Rng random(item_seed(7, static_cast<std::uint64_t>(k)));
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column) {
        const double x = (column + 0.5) * all.spacing - 1;
        const double y = (row + 0.5) * all.spacing - 1;
        const double rest = 1 - x * x - y * y;
        const bool hit = rest > 0.03;  // at 80 degrees of incidence
        scan.grid->cells.push_back(hit ? static_cast<std::int32_t>(scan.cloud.size()) : RangeGrid::missing);
        if (hit)
          scan.cloud.positions.emplace_back(x, y, -std::sqrt(rest) + all.spacing / 3 * random.normal());
      }
    scan.cloud.confidences.assign(scan.cloud.size(), 1.0F);
    all.scans.push_back(std::move(scan));
    all.world_from_scan.emplace_back(
        Eigen::AngleAxisd(k < 4 ? k * std::numbers::pi / 2 : 0, Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(k < 4 ? 0 : (k == 4 ? 1 : -1) * std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
  }
  return all;
}

void measure(const std::string& name, const Scans& input, std::optional<double> voxel) {
  meshing::MeshOptions options;
  if (voxel) options.fusion_voxel_spacings = *voxel / input.spacing;
  const PointCloud none;
  reset_peak_memory();
  const double scans_megabytes = status_megabytes("VmRSS");
  const double start = cpu_seconds();
  const meshing::MeshResult result =
      meshing::mesh_scans({input.scans, input.world_from_scan, none, input.spacing}, options);
  fmt::print("{:<16} {:>9} points {:>6.2f} CPU s {:>6.0f} MB peak (scans {:.0f} MB) {:>9} faces\n", name,
             input.points(), cpu_seconds() - start, status_megabytes("VmHWM"), scans_megabytes,
             result.mesh.faces.size());
}

// Of three runs the fastest: the first one also loads what CGAL needs.
template <class Work>
double least_cpu_seconds(Work work) {
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 3; ++run) {
    const double start = cpu_seconds();
    work();
    least = std::min(least, cpu_seconds() - start);
  }
  return least;
}

// A band of a sphere between a loop of 4,000 edges and one of 2,000.
TriangleMesh band_between_long_loops() {
  const TriangleMesh sphere = test::sphere(10, 1000);
  std::vector<std::uint8_t> keep;
  for (const Face& f : sphere.faces) {
    const double z = (sphere.vertices[f[0]].z() + sphere.vertices[f[1]].z() + sphere.vertices[f[2]].z()) / 3;
    keep.push_back(z > 8 && z < 9 ? 1 : 0);
  }
  return with_faces(sphere, keep);
}

void measure_filling() {
  const TriangleMesh band = band_between_long_loops();
  meshing::FillOptions all;
  all.keep_outer_border = false;
  all.max_hole_size_spacings = 1e6;
  all.simplify_triangles = 0;
  std::string what;
  const double seconds = least_cpu_seconds([&] {
    what.clear();
    for (const meshing::Hole& hole : meshing::fill_holes(band, median_edge_length(band), all).holes)
      what +=
          fmt::format("; {} edges: {}, {}", hole.boundary_edges, meshing::to_string(hole.action), hole.why);
  });
  fmt::print("two long loops   {:.2f} CPU s{}\n", seconds, what);
  if (!test::have_data("meshes/bun_zipper.ply")) {
    fmt::print("bun_zipper: skipped, needs meshes/bun_zipper.ply of DRAPE_TEST_DATA\n");
    return;
  }
  const TriangleMesh mesh = io::read_mesh(test::data("meshes/bun_zipper.ply"));
  meshing::FillOptions options;
  options.simplify_triangles = 0;
  std::size_t holes = 0;
  const double fill_seconds = least_cpu_seconds(
      [&] { holes = meshing::fill_holes(mesh, median_edge_length(mesh), options).holes.size(); });
  fmt::print("fill bun_zipper  {} loops in {:.3f} CPU s\n", holes, fill_seconds);
  const double simplify_seconds = least_cpu_seconds([&] {
    (void)meshing::simplified(mesh, {mesh.faces.size() / 10, 0});
  });
  fmt::print("simplify         {} faces to a tenth in {:.3f} CPU s\n", mesh.faces.size(), simplify_seconds);
}

}  // namespace
}  // namespace drape

int main(int count, char** arguments) {
  std::vector<std::string> rows(arguments + 1, arguments + count);
  if (rows.empty()) rows = {"bunny", "filling", "360000", "3600000"};
  for (const std::string& row : rows) {
    if (row == "filling")
      drape::measure_filling();
    else if (row != "bunny")
      drape::measure("six-view sphere", drape::sphere_scans(std::stoul(row)), std::nullopt);
    else if (drape::test::have_data("scans/bunny/bun.conf"))
      drape::measure("bunny, 0.5 mm", drape::bunny(), 0.0005);
    else
      fmt::print("bunny: skipped, needs scans/bunny of DRAPE_TEST_DATA\n");
  }
}
