// Which files of earlier stages a stage reads.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "drape/pipeline/records.hpp"
#include "drape/pipeline/stage.hpp"

namespace drape::pipeline {

/// `*` in the pattern stands for any characters but '/'.
[[nodiscard]] bool matches(std::string_view pattern, std::string_view name);

/// Of the results so far (stage -> record), the digests of the files that `stage` reads.
[[nodiscard]] UpstreamDigests upstream_digests(const Stage& stage,
                                               const std::map<std::string, StageRecord>& results);

}  // namespace drape::pipeline
