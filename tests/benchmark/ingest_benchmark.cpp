// How fast scans are read, and in how much memory: binary PLY and PTX of 0.4 and 4 million points (with an
// argument, of that many million as well). Each reading happens in a process of its own, whose peak memory is
// its own.
#include <fmt/core.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

#include "drape/base/log.hpp"
#include "drape/io/scan_files.hpp"
#include "support.hpp"

namespace drape {
namespace {

Eigen::Vector3f point(std::size_t i, std::size_t columns) {
  const auto row = static_cast<float>(i / columns) * 1e-3F, column = static_cast<float>(i % columns) * 1e-3F;
  return {column, row, 5 + 0.1F * std::sin(9 * row) * std::cos(7 * column)};
}

void write_ply(const std::filesystem::path& file, std::size_t count) {
  std::FILE* out = std::fopen(file.c_str(), "wb");
  fmt::print(out,
             "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
             "property float z\nend_header\n",
             count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f p = point(i, 2000);
    std::fwrite(p.data(), sizeof(float), 3, out);
  }
  std::fclose(out);
}

void write_ptx(const std::filesystem::path& file, std::size_t count) {
  std::FILE* out = std::fopen(file.c_str(), "wb");
  fmt::print(out, "{}\n2000\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", count / 2000);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f p = point(i, 2000);
    fmt::print(out, "{:.6f} {:.6f} {:.6f} 0.5\n", p.x(), p.y(), p.z());
  }
  std::fclose(out);
}

/// CPU seconds and peak memory of `work` beyond a process that does nothing.
struct Cost {
  double seconds;
  double bytes;
};
Cost cost_of(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    work();
    std::_Exit(0);
  }
  int status = 0;
  rusage usage{};
  ::wait4(child, &status, 0, &usage);
  if (status != 0) std::exit(1);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime), 1024.0 * static_cast<double>(usage.ru_maxrss)};
}

void measure(std::size_t count, std::size_t most_points) {
  const test::ScratchFolder folder;
  const Cost nothing = cost_of([] {});
  for (const bool ply : {true, false}) {
    const std::filesystem::path file = folder / (ply ? "a.ply" : "a.ptx");
    (ply ? write_ply : write_ptx)(file, count);
    const Cost cost = cost_of([&] {
      const auto scans = io::read_scans(file, {.most_points = most_points});
      if (scans.empty() || (most_points == 0 && scans[0].cloud.size() != count)) std::_Exit(1);
    });
    const double bytes = cost.bytes - nothing.bytes;
    const auto size = static_cast<double>(std::filesystem::file_size(file));
    fmt::print(
        "{:<4}{:>10} points{:>14} {:8.2f} s  {:6.2f} M points/s  {:6.0f} MB/s  peak {:6.0f} MB  {:5.1f} "
        "bytes/point\n",
        ply ? "PLY" : "PTX", count, most_points == 0 ? "" : fmt::format("keep {:.0e}", double(most_points)),
        cost.seconds, static_cast<double>(count) / cost.seconds / 1e6, size / cost.seconds / 1e6, bytes / 1e6,
        bytes / static_cast<double>(count));
    std::filesystem::remove(file);
  }
}

}  // namespace
}  // namespace drape

int main(int argc, char** argv) {
  drape::log::set_console_level(drape::log::Level::warning);
  std::vector<std::size_t> counts{400'000, 4'000'000};
  if (argc > 1) counts.push_back(static_cast<std::size_t>(std::atof(argv[1]) * 1e6));
  for (const std::size_t count : counts) drape::measure(count, 0);
  drape::measure(4'000'000, 1'000'000);
}
