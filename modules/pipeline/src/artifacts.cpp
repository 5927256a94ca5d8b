#include "artifacts.hpp"

namespace drape::pipeline {

bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern.front() == '*') {
    for (std::size_t taken = 0; taken <= name.size(); ++taken) {
      if (matches(pattern.substr(1), name.substr(taken))) return true;
      if (taken < name.size() && name[taken] == '/') return false;
    }
    return false;
  }
  return !name.empty() && name.front() == pattern.front() && matches(pattern.substr(1), name.substr(1));
}

UpstreamDigests upstream_digests(const Stage& stage, const std::map<std::string, StageRecord>& results) {
  UpstreamDigests digests;
  for (const Artifact& artifact : stage.reads) {
    const auto result = results.find(artifact.stage);
    if (result == results.end()) continue;
    for (const StageFile& file : result->second.files)
      if (matches(artifact.pattern, file.name)) digests[artifact.stage + "/" + file.name] = file.digest;
  }
  return digests;
}

}  // namespace drape::pipeline
