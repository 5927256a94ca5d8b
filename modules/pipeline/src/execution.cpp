#include "execution.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "artifacts.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;

bool Execution::has_artifact(std::string_view stage, std::string_view file) const {
  const auto result = results_.find(std::string(stage));
  if (result == results_.end()) return false;
  const auto& files = result->second.files;
  return std::any_of(files.begin(), files.end(), [&](const StageFile& f) { return f.name == file; });
}

fs::path Execution::artifact(std::string_view stage, std::string_view file) const {
  const bool named = std::any_of(stage_.reads.begin(), stage_.reads.end(), [&](const Artifact& a) {
    return a.stage == stage && matches(a.pattern, file);
  });
  // What is not in `reads` is not in the key either.
  if (!named || !has_artifact(stage, file))
    throw Error(ErrorCode::bug, fmt::format("stage {} asks for {}/{}, which it does not read or is not there",
                                            stage_.name, stage, file));
  return workspace_.stage_folder(std::string(stage), results_.at(std::string(stage)).key) / file;
}

fs::path Execution::output(std::string_view file) {
  if (std::none_of(stage_.writes.begin(), stage_.writes.end(),
                   [&](const std::string& p) { return matches(p, file); }))
    throw Error(ErrorCode::bug,
                fmt::format("stage {} writes {}, which its row does not name", stage_.name, file));
  fs::path path = folder_ / file;
  make_folder(path.parent_path());
  return path;
}

}  // namespace drape::pipeline
