// The identity of a stage's result: everything that its bytes depend on, and nothing else.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "drape/pipeline/config.hpp"
#include "drape/pipeline/file_digests.hpp"

namespace drape::pipeline {

/// One thing that a result depends on: "option.base" = "flat", "input.scans[0]" = a digest, ...
struct KeyPart {
  std::string name;
  std::string value;     // exact: what is hashed
  std::string readable;  // for people

  bool operator==(const KeyPart&) const = default;
};

/// File of an earlier stage -> its digest; names are "stage/file".
using UpstreamDigests = std::map<std::string, std::string>;

/// The parts for a stage: its version, options (defaults expanded), the parts of `input` that it reads, the
/// digests of the upstream files that it reads, and the seed. Folders, times, host and thread count are left
/// out on purpose.
[[nodiscard]] std::vector<KeyPart> key_parts(const ConfiguredStage& stage, const Config& config,
                                             const UpstreamDigests& upstream, FileDigests& digests);

/// 32 hexadecimal digits of the SHA-256 over all parts.
[[nodiscard]] std::string key_of(const std::string& stage, const std::vector<KeyPart>& parts);

/// What differs, in words: "option fill.base: auto -> flat", "input.scans[0] changed".
[[nodiscard]] std::vector<std::string> differences(const std::string& stage,
                                                   const std::vector<KeyPart>& before,
                                                   const std::vector<KeyPart>& now);

}  // namespace drape::pipeline
