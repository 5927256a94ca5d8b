// What cleaning a scan and finding its normals costs, with and without a grid, and what PCL's calls for
// outliers and normals alone cost on the same points (on one thread, as they are).
//
//   cleaning_benchmark [points in thousands ...]      default: 360 1500
#include <fmt/core.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "drape/base/numbers.hpp"
#include "drape/base/random.hpp"
#include "drape/ingest/clean_scan.hpp"
#include "peer_programs.hpp"
#include "support.hpp"

namespace drape {
namespace {

// A wavy square seen straight on, with noise and one stray in a thousand.
RangeScan waves(std::size_t thousands, bool grid) {
  const int side = static_cast<int>(std::sqrt(1000.0 * static_cast<double>(thousands)));
  Rng rng(1);
  RangeScan scan;
  scan.view = {ScanView::Kind::direction, -Eigen::Vector3d::UnitZ()};
  if (grid) scan.grid = RangeGrid{side, side, {}};
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const double x = column + 0.1 * rng.normal();
      const double y = row + 0.1 * rng.normal();
      double z = 20 * std::sin(x / 40) * std::cos(y / 50) + 0.2 * rng.normal();
      if (rng.below(1000) == 0) z += rng.uniform(-200, 200);
      if (grid) scan.grid->cells.push_back(static_cast<std::int32_t>(scan.cloud.size()));
      scan.cloud.positions.emplace_back(x, y, z);
    }
  return scan;
}

struct Cost {
  double seconds;
  double cpu_seconds;
};

Cost cost_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
          static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC};
}

void print_cost(std::size_t points, const char* what, const Cost& cost) {
  fmt::print("{:>8} points, {:<22} {:6.2f} s, {:6.2f} CPU s", points, what, cost.seconds, cost.cpu_seconds);
}

void measure(std::size_t thousands, bool grid) {
  const RangeScan raw = waves(thousands, grid);
  ingest::CleanedScan cleaned;
  const Cost cost = cost_of([&] { cleaned = ingest::clean_scan(raw, {}, {}); });
  print_cost(raw.cloud.size(), grid ? "drape, with a grid" : "drape, no grid", cost);
  for (const auto& [filter, count] : cleaned.dropped)
    if (count > 0) fmt::print("; {} {}", count, filter);
  fmt::print("\n");
}

// Statistical outliers, then normals, with as many neighbours as drape looks at.
void measure_pcl(std::size_t thousands) {
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const auto& p : waves(thousands, false).cloud.positions)
    cloud->emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  const std::size_t before = cloud->size();
  const ingest::CleanOptions options;
  auto kept = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  const Cost cost = cost_of([&] {
    pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
    filter.setInputCloud(cloud);
    filter.setMeanK(options.outlier_neighbors);
    filter.setStddevMulThresh(options.outlier_sigma);
    filter.filter(*kept);
    pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(kept);
    estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
    estimation.setKSearch(21);
    pcl::PointCloud<pcl::Normal> normals;
    estimation.compute(normals);
  });
  print_cost(before, "PCL", cost);
  fmt::print("; {} outlier\n", before - kept->size());
}

// The same by programs of their own, with reading and writing their files.
void measure_programs(std::size_t thousands) {
  const RangeScan scan = waves(thousands, false);
  const ingest::CleanOptions options;
  const test::ScratchFolder folder;
  test::write_peer_cloud(folder / "a.pcd", scan.cloud.positions);
  test::write_peer_cloud(folder / "a.xyz", scan.cloud.positions);
  const std::string in_folder = "cd " + folder.path().string() + " && ";
  const auto measure_one = [&](const char* program, const char* name, const std::string& command,
                               const char* result) {
    if (!test::is_installed(program)) return fmt::print("{}: skipped, not installed\n", program);
    const auto run = test::run_peer(in_folder + command);
    if (!run || !std::filesystem::exists(folder / result)) return fmt::print("{}: failed\n", program);
    print_cost(scan.cloud.size(), name, {run->seconds, run->cpu_seconds});
    fmt::print("\n");
  };
  measure_one("pcl_outlier_removal", "pcl-tools",
              fmt::format("pcl_outlier_removal a.pcd b.pcd -method statistical -mean_k {} -std_dev_mul {} && "
                          "pcl_normal_estimation b.pcd c.pcd -k 21",
                          options.outlier_neighbors, options.outlier_sigma),
              "c.pcd");
  measure_one(
      "CloudCompare", "CloudCompare",
      fmt::format("CloudCompare -SILENT -NO_TIMESTAMP -AUTO_SAVE OFF -C_EXPORT_FMT PLY -O a.xyz -SOR {} {} "
                  "-OCTREE_NORMALS auto -SAVE_CLOUDS FILE d.ply",
                  options.outlier_neighbors, options.outlier_sigma),
      "d.ply");
}

}  // namespace
}  // namespace drape

int main(int count, char** texts) {
  std::vector<std::size_t> sizes;
  for (int i = 1; i < count; ++i)
    if (const auto size = drape::parse_integer(texts[i]); size && *size > 0)
      sizes.push_back(static_cast<std::size_t>(*size));
    else
      return fmt::print("usage: cleaning_benchmark [points in thousands ...]\n"), 64;
  if (sizes.empty()) sizes = {360, 1500};
  for (const std::size_t size : sizes) {
    for (const bool grid : {false, true}) drape::measure(size, grid);
    drape::measure_pcl(size);
    drape::measure_programs(size);
  }
  return 0;
}
