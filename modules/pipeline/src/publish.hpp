// Copies of finished files, for the user to take away.
#pragma once

#include <filesystem>
#include <vector>

#include "drape/pipeline/file_digests.hpp"
#include "drape/pipeline/records.hpp"

namespace drape::pipeline {

/// Copies the result's files from `folder` to `output`, as real files that survive a power cut: written
/// aside, synced, renamed. What is there with the same bytes stays untouched. Returns the files in `output`.
/// Error{io}.
std::vector<std::filesystem::path> publish(const StageRecord& record, const std::filesystem::path& folder,
                                           const std::filesystem::path& output, FileDigests& digests);

}  // namespace drape::pipeline
