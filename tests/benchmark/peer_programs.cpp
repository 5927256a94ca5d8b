#include "peer_programs.hpp"

#include <fmt/core.h>
#include <sys/resource.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <iterator>

#include "drape/base/files.hpp"

namespace drape::test {
namespace {

double children_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

bool is_installed(const std::string& program) {
  return run_peer("command -v " + program).has_value();
}

void write_peer_cloud(const std::filesystem::path& file, std::span<const Eigen::Vector3d> points) {
  std::string text;
  if (file.extension() == ".pcd")
    text = fmt::format(
        "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {0}\nHEIGHT 1\nVIEWPOINT 0 0 0 "
        "1 0 0 "
        "0\nPOINTS {0}\nDATA ascii\n",
        points.size());
  for (const Eigen::Vector3d& p : points)
    fmt::format_to(std::back_inserter(text), "{:.9g} {:.9g} {:.9g}\n", p.x(), p.y(), p.z());
  write_file(file, text);
}

std::optional<PeerRun> run_peer(const std::string& command) {
  PeerRun run;
  const auto begin = std::chrono::steady_clock::now();
  const double cpu = children_seconds();
  std::FILE* pipe =
      ::popen(("export QT_QPA_PLATFORM=offscreen; timeout 600 sh -c '" + command + "' 2>&1").c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::array<char, 4096> part{};
  for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), pipe)) > 0;)
    run.out.append(part.data(), got);
  if (::pclose(pipe) != 0) return std::nullopt;
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.cpu_seconds = children_seconds() - cpu;
  return run;
}

}  // namespace drape::test
