#include "run_selection.hpp"

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/pipeline/config_node.hpp"

namespace drape::app {
namespace fs = std::filesystem;

fs::path workspace_of(const fs::path& where) {
  if (!fs::exists(where)) throw input_error("{}: no such workspace or configuration", where.string());
  if (!fs::is_directory(where)) {
    const pipeline::ConfigNode root = pipeline::parse_yaml(read_file(where), where.string());
    const pipeline::ConfigNode* workspace = root.find("workspace");
    return (fs::absolute(where).parent_path() / (workspace == nullptr ? "drape-workspace" : workspace->text))
        .lexically_normal();
  }
  const fs::path folder =
      fs::absolute(fs::exists(where / "runs") ? where : where / "drape-workspace").lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();
}

SelectedRun select_run(const std::string& run, const std::optional<fs::path>& workspace) {
  fs::path folder = fs::absolute(run).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  if (fs::is_regular_file(folder))
    folder = (workspace ? workspace_of(*workspace) : workspace_of(folder)) / "runs" / folder.stem();
  else if (!fs::exists(folder / "run.json"))
    folder = workspace_of(workspace.value_or(".")) / "runs" / run;
  const auto record = pipeline::read_run_record(folder / "run.json");
  if (!record)
    throw input_error(
        "{}: there is no such run; name a run of the workspace, its folder, or its configuration", run);
  // A name may have folders in it: runs/<batch>/<object>.
  fs::path root = folder;
  while (root.has_relative_path() && root.filename() != "runs") root = root.parent_path();
  return {pipeline::Workspace(root.parent_path()), *record};
}

}  // namespace drape::app
