#include <fmt/core.h>

#include "commands.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/pipeline/config_node.hpp"
#include "drape/pipeline/workspace.hpp"

namespace drape::app {
namespace fs = std::filesystem;
namespace {

// A configuration's workspace is told without checking the rest of it: the files it names may be gone by now.
fs::path workspace_of(const fs::path& where) {
  if (!fs::exists(where)) throw input_error("{}: no such workspace or configuration", where.string());
  if (!fs::is_directory(where)) {
    const pipeline::ConfigNode root = pipeline::parse_yaml(read_file(where), where.string());
    const pipeline::ConfigNode* workspace = root.find("workspace");
    return fs::absolute(where).parent_path() / (workspace == nullptr ? "drape-workspace" : workspace->text);
  }
  return fs::exists(where / "runs") ? where : where / "drape-workspace";
}

}  // namespace

void status_command(const fs::path& where) {
  const fs::path folder = workspace_of(where).lexically_normal();
  const auto runs = pipeline::Workspace(folder).runs();
  if (runs.empty()) {
    fmt::print("{}: no runs yet\n", folder.string());
    return;
  }
  fmt::print("{}\n{:<20} {:<12} {:<21} {:>9}  {}\n", folder.string(), "run", "status", "started", "seconds",
             "stages");
  for (const pipeline::RunRecord& run : runs) {
    std::string stages;
    for (const pipeline::RunStage& stage : run.stages) stages += (stages.empty() ? "" : " ") + stage.stage;
    fmt::print("{:<20} {:<12} {:<21} {:>9.2f}  {}\n", run.name, run.status, run.started_at, run.seconds,
               stages);
    for (const std::string& reason : run.reasons) fmt::print("{:<20} {}\n", "", reason);
  }
}

}  // namespace drape::app
