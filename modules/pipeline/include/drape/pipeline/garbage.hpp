// What may go from a workspace.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drape/pipeline/workspace.hpp"

namespace drape::pipeline {

struct Garbage {
  struct Item {
    std::filesystem::path path;
    std::string why;  // "no run links to it", "damaged, put aside", "left by a process that died"
    std::uint64_t bytes = 0;
    std::int64_t modified_s = 0;
  };
  std::vector<Item> items;          // oldest first
  std::uint64_t linked_bytes = 0;   // of results that runs link to: these stay
  std::uint64_t garbage_bytes = 0;  // of the items
  std::uint64_t kept_bytes = 0;     // of results without a run that fit under the limit
};

/// Results that no run links to or names in its record, results put aside as damaged, and what processes that
/// died left behind. With `max_bytes`, of results without a run only the oldest, as many as bring all stages'
/// results together under that size. Results made in the last `min_age_s` seconds stay.
[[nodiscard]] Garbage find_garbage(const Workspace& workspace, std::optional<std::uint64_t> max_bytes,
                                   double min_age_s);

/// Finds and removes it, with no other process at work in the workspace. Error{try_again} if there is one.
Garbage remove_garbage(const Workspace& workspace, std::optional<std::uint64_t> max_bytes, double min_age_s);

}  // namespace drape::pipeline
