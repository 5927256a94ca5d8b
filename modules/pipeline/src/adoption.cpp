#include "drape/pipeline/adoption.hpp"

#include "drape/base/hash.hpp"
#include "json_file.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

fs::path list_of(const Workspace& workspace, const std::string& run) {
  return workspace.run_folder(run) / "adopted.json";
}

void write_adoptions(const Workspace& workspace, const std::string& run,
                     const std::vector<Adoption>& adoptions) {
  Json json = Json::array();
  for (const Adoption& adoption : adoptions)
    json.push_back({{"stage", adoption.stage},
                    {"file", adoption.file},
                    {"sha256", adoption.digest},
                    {"came_from", adoption.came_from},
                    {"adopted_at", adoption.adopted_at}});
  write_json(list_of(workspace, run), json);
}

}  // namespace

std::vector<Adoption> read_adoptions(const Workspace& workspace, const std::string& run) {
  const fs::path file = list_of(workspace, run);
  if (!fs::exists(file)) return {};
  try {
    std::vector<Adoption> adoptions;
    for (const Json& entry : Json::parse(read_file(file)))
      adoptions.push_back({entry.at("stage"), entry.at("file"), entry.at("sha256"), entry.at("came_from"),
                           entry.at("adopted_at")});
    return adoptions;
  } catch (const Json::exception&) {
    throw input_error("{}: is damaged; remove it to go on without the adopted files", file.string());
  }
}

fs::path adopted_file(const Workspace& workspace, const std::string& run, const Adoption& adoption) {
  return workspace.run_folder(run) / "adopted" / adoption.stage / adoption.file;
}

void adopt(const Workspace& workspace, const std::string& run, const std::string& stage,
           const std::string& file, const fs::path& contents, const std::string& came_from) {
  Adoption adoption{stage, file, sha256_file(contents), came_from, utc_now()};
  const fs::path target = adopted_file(workspace, run, adoption);
  make_folder(target.parent_path());
  write_file(target, read_file(contents));
  std::vector<Adoption> adoptions = read_adoptions(workspace, run);
  std::erase_if(adoptions, [&](const Adoption& a) { return a.stage == stage && a.file == file; });
  adoptions.push_back(std::move(adoption));
  write_adoptions(workspace, run, adoptions);
}

std::size_t forget_adoptions(const Workspace& workspace, const std::string& run, const std::string& stage) {
  std::vector<Adoption> adoptions = read_adoptions(workspace, run);
  const std::size_t count = std::erase_if(adoptions, [&](const Adoption& a) { return a.stage == stage; });
  if (count > 0) write_adoptions(workspace, run, adoptions);
  std::error_code ignored;
  fs::remove_all(workspace.run_folder(run) / "adopted" / stage, ignored);
  return count;
}

}  // namespace drape::pipeline
