// Other programs for the same work, where they are installed.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace drape::test {

/// Whether a program of that name is on the PATH.
[[nodiscard]] bool is_installed(const std::string& program);

struct PeerRun {
  double seconds = 0;      // as the user waits
  double cpu_seconds = 0;  // of the process, with reading and writing its files
  std::string out;         // what it printed
};

/// The points in text: a .pcd of floats for PCL, an .xyz for CloudCompare.
void write_peer_cloud(const std::filesystem::path& file, std::span<const Eigen::Vector3d> points);

/// Runs a shell command without a display; nothing where it fails (some programs end with 0 all the same:
/// look at what they wrote).
[[nodiscard]] std::optional<PeerRun> run_peer(const std::string& command);

}  // namespace drape::test
