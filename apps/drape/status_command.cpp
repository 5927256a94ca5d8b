#include <fmt/core.h>

#include "commands.hpp"
#include "drape/pipeline/workspace.hpp"
#include "run_selection.hpp"

namespace drape::app {
namespace fs = std::filesystem;
void status_command(const fs::path& where) {
  const fs::path folder = workspace_of(where);
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
