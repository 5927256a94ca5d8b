// A run as the user names it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drape/pipeline/config.hpp"
#include "drape/pipeline/workspace.hpp"

namespace drape::app {

/// A workspace, or a folder with one, or a configuration, whose workspace is told without checking the rest
/// of it: the files it names may be gone by now. Error{input} if there is nothing of the name.
[[nodiscard]] std::filesystem::path workspace_of(const std::filesystem::path& where);

struct SelectedRun {
  pipeline::Workspace workspace;
  pipeline::RunRecord record;
};

/// `run`: a run's folder, a configuration (its own run), or a run's name in `workspace` (default:
/// drape-workspace here). Error{input} if there is no such run.
[[nodiscard]] SelectedRun select_run(const std::string& run,
                                     const std::optional<std::filesystem::path>& workspace);

}  // namespace drape::app
