// Files made by hand that a run takes in place of a stage's own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "drape/pipeline/workspace.hpp"

namespace drape::pipeline {

struct Adoption {
  std::string stage;
  std::string file;        // the stage's file that it stands for, such as "mesh.ply"
  std::string digest;      // of the adopted bytes
  std::string came_from;   // the file that the user named
  std::string adopted_at;  // ISO 8601, UTC
};

/// What the run has adopted: runs/<run>/adopted.json, the files lie in runs/<run>/adopted/<stage>/.
/// Error{input} if that file is damaged: what a person made is not passed over in silence.
[[nodiscard]] std::vector<Adoption> read_adoptions(const Workspace& workspace, const std::string& run);

/// Copies `contents` into the run's folder and records it, in place of what was adopted for the same file.
void adopt(const Workspace& workspace, const std::string& run, const std::string& stage,
           const std::string& file, const std::filesystem::path& contents, const std::string& came_from);

/// The stage makes its own files again. Returns how many adoptions there were.
std::size_t forget_adoptions(const Workspace& workspace, const std::string& run, const std::string& stage);

[[nodiscard]] std::filesystem::path adopted_file(const Workspace& workspace, const std::string& run,
                                                 const Adoption& adoption);

}  // namespace drape::pipeline
