// How adopted files take part in a stage's key.
#pragma once

#include <string>
#include <vector>

#include "drape/pipeline/adoption.hpp"
#include "drape/pipeline/key.hpp"

namespace drape::pipeline {

/// Adds "adopted.<file>" for each.
void add_adopted(std::vector<KeyPart>& parts, const std::vector<Adoption>& adopted);
[[nodiscard]] std::vector<KeyPart> without_adopted(std::vector<KeyPart> parts);
/// Whether the adopted files are all that the stage writes, so that it need not run.
[[nodiscard]] bool covers(const std::vector<Adoption>& adopted, const Stage& stage);

}  // namespace drape::pipeline
