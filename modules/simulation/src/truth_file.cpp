#include "truth_file.hpp"

#include <nlohmann/json.hpp>

#include "drape/base/files.hpp"

namespace drape::simulation {

void write_truth(const std::filesystem::path& file, const io::PosesRecord& poses,
                 const io::CamerasRecord& cameras) {
  using Json = nlohmann::ordered_json;
  write_file_aside(file, [&](const std::filesystem::path& aside) {
    io::write_poses(aside, poses);
    Json truth = Json::parse(read_file(aside));
    io::write_cameras(aside, cameras);
    truth["cameras"] = Json::parse(read_file(aside)).at("cameras");
    write_file(aside, truth.dump(1) + "\n");
  });
}

}  // namespace drape::simulation
