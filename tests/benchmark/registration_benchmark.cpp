// The bunny's 045 -> 000, raw points to pose, everything included, against PCL's generalised ICP in the same
// run. Both start from the published pose turned by 4 degrees and shifted by 4 mm. Times are CPU seconds; the
// best of three runs.
#include <fmt/core.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "drape/base/parallel.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/registration/register_scans.hpp"
#include "peer_programs.hpp"
#include "program_arguments.hpp"
#include "support.hpp"

namespace drape {
namespace {

using test::cpu_seconds;

struct Error {
  double degrees;
  double millimetres;
};

Error error_of(const Rigid3& found, const Rigid3& truth, const PointCloud& cloud) {
  double sum = 0;
  for (const auto& p : cloud.positions) sum += (found * p - truth * p).norm();
  return {Eigen::AngleAxisd(found.linear().transpose() * truth.linear()).angle() * 180 / std::numbers::pi,
          1000 * sum / static_cast<double>(cloud.size())};
}

template <class Run>
double best_seconds(const Run& run) {
  double best = std::numeric_limits<double>::max();
  for (int round = 0; round < 3; ++round) {
    const double start = cpu_seconds();
    run();
    best = std::min(best, cpu_seconds() - start);
  }
  return best;
}

pcl::PointCloud<pcl::PointXYZ>::Ptr to_pcl(const PointCloud& cloud) {
  auto result = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  for (const auto& p : cloud.positions)
    result->emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  return result;
}

Error error_of(const std::vector<Eigen::Vector3d>& found, const Rigid3& truth, const PointCloud& cloud) {
  const auto count = static_cast<Eigen::Index>(std::min(found.size(), cloud.size()));
  const Eigen::Map<const Eigen::Matrix3Xd> from(cloud.positions[0].data(), 3, count);
  const Eigen::Map<const Eigen::Matrix3Xd> to(found[0].data(), 3, count);
  Rigid3 motion;
  motion.matrix() = Eigen::umeyama(from, to, false);
  return error_of(motion, truth, cloud);
}

void print_peer(const char* name, const std::optional<test::PeerRun>& run,
                const std::filesystem::path& result, const Rigid3& truth, const PointCloud& cloud) {
  if (!run || !std::filesystem::exists(result)) return fmt::print("{:<28} failed\n", name);
  const PointCloud found = io::read_scans(result)[0].cloud;
  if (found.size() != cloud.size()) return fmt::print("{:<28} lost points\n", name);
  const Error error = error_of(found.positions, truth, cloud);
  fmt::print("{:<28} {:.3f} s  {:.3f} deg  {:.3f} mm\n", name, run->cpu_seconds, error.degrees,
             error.millimetres);
}

// Programs of their own, which read and write files too: from the same start, on the same points.
void compare_programs(const RangeScan& target, const RangeScan& source, const Rigid3& guess,
                      const Rigid3& truth) {
  const test::ScratchFolder folder;
  std::vector<Eigen::Vector3d> moved;
  for (const auto& p : source.cloud.positions) moved.push_back(guess * p);
  test::write_peer_cloud(folder / "target.pcd", target.cloud.positions);
  test::write_peer_cloud(folder / "source.pcd", moved);
  test::write_peer_cloud(folder / "target.xyz", target.cloud.positions);
  test::write_peer_cloud(folder / "source.xyz", moved);
  const std::string in_folder = "cd " + folder.path().string() + " && mkdir -p out && cd out && ";
  if (test::is_installed("CloudCompare"))
    print_peer(
        "CloudCompare -ICP (process)",
        test::run_peer(in_folder + "CloudCompare -SILENT -NO_TIMESTAMP -C_EXPORT_FMT PLY -O ../source.xyz -O "
                                   "../target.xyz -ICP -OVERLAP 60 && mv ../source_REGISTERED.ply cc.ply"),
        folder / "out/cc.ply", truth, source.cloud);
  else
    fmt::print("CloudCompare                 skipped: not installed\n");
  if (test::is_installed("pcl_icp"))
    print_peer("pcl_icp (process)",
               test::run_peer(in_folder + "pcl_icp -d 0.01 -i 50 ../target.pcd ../source.pcd"),
               folder / "out/source.pcd", truth, source.cloud);
  else
    fmt::print("pcl_icp                      skipped: not installed\n");
}

void compare() {
  if (!test::have_data("scans/bunny")) return fmt::print("skipped: needs scans/bunny\n");
  const auto poses = io::read_scan_poses(test::data("scans/bunny/bun.conf"));
  const std::vector<RangeScan> scans{io::read_scans(test::data("scans/bunny/bun000.ply"))[0],
                                     io::read_scans(test::data("scans/bunny/bun045.ply"))[0]};
  const Rigid3 truth = poses.at("bun000.ply").inverse() * poses.at("bun045.ply");
  const Rigid3 off = Eigen::Translation3d(0.002, -0.003, 0.0017) * Eigen::Translation3d(0, 0.1, 0) *
                     Eigen::AngleAxisd(4 * std::numbers::pi / 180, Eigen::Vector3d(1, 2, -1).normalized()) *
                     Eigen::Translation3d(0, -0.1, 0);
  const Rigid3 guess = off * truth;

  Rigid3 ours;
  int steps = 0;
  const double our_seconds = best_seconds([&] {
    const std::vector<std::optional<Rigid3>> given{Rigid3::Identity(), guess};
    const auto found = registration::register_scans(scans, given, {}, {});
    steps = found.iterations;
    ours = found.scans[0].world_from_scan.inverse() * found.scans[1].world_from_scan;
  });
  Rigid3 theirs = Rigid3::Identity();
  const double their_seconds = best_seconds([&] {
    pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    const auto source = to_pcl(scans[1].cloud);
    const auto target = to_pcl(scans[0].cloud);
    icp.setInputSource(source);
    icp.setInputTarget(target);
    icp.setMaxCorrespondenceDistance(0.01);
    pcl::PointCloud<pcl::PointXYZ> aligned;
    icp.align(aligned, guess.matrix().cast<float>());
    theirs.matrix() = icp.getFinalTransformation().cast<double>();
  });
  const Error our_error = error_of(ours, truth, scans[1].cloud);
  const Error their_error = error_of(theirs, truth, scans[1].cloud);
  fmt::print("{} and {} points, from raw points to the merged cloud\n", scans[0].cloud.size(),
             scans[1].cloud.size());
  fmt::print("drape     {:.3f} s  {:.3f} deg  {:.3f} mm, {} steps\n", our_seconds, our_error.degrees,
             our_error.millimetres, steps);
  fmt::print("PCL GICP  {:.3f} s  {:.3f} deg  {:.3f} mm\n", their_seconds, their_error.degrees,
             their_error.millimetres);
  fmt::print("drape takes 1/{:.1f} of the time\n", their_seconds / our_seconds);
  compare_programs(scans[0], scans[1], guess, truth);
}

}  // namespace
}  // namespace drape

int main() {
  drape::compare();
  return 0;
}
