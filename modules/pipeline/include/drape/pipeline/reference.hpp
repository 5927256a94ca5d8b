// The reference page of all keys of a configuration.
#pragma once

#include <span>
#include <string>

#include "drape/pipeline/stage.hpp"

namespace drape::pipeline {

/// Markdown: the input section, then each stage with its options, defaults, limits and meaning.
[[nodiscard]] std::string reference_page(std::span<const Stage> table);

}  // namespace drape::pipeline
