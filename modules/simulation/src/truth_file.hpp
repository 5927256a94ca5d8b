// What a simulation knows, for those who compare with it.
#pragma once

#include <filesystem>

#include "drape/io/records.hpp"

namespace drape::simulation {

/// One JSON file that reads as cameras.json (io::read_cameras) and as poses.json (io::read_poses).
void write_truth(const std::filesystem::path& file, const io::PosesRecord& poses,
                 const io::CamerasRecord& cameras);

}  // namespace drape::simulation
