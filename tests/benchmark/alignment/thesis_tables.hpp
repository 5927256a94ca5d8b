// Chapter 5 of the thesis again: its method, and the silhouette method on the same stencils.
#pragma once

#include <nlohmann/json.hpp>

namespace drape::lab {

struct ThesisRun {
  double first_pass_step_deg = 45;
  double max_candidates_percent = 100;  // of the first pass's list
  int stencils = 1;                     // per model
  double limit_s = 60;                  // CPU seconds of a stencil: what takes longer is given up
};

/// Prints one table as the thesis's 5.2 (45 degrees) or 5.3 (20 degrees), its own figures beside. Times are
/// CPU seconds; the thesis's are its machine's.
[[nodiscard]] nlohmann::json print_thesis_table(const ThesisRun& run);

/// Table 5.1: the models' sizes, the thesis's beside.
void print_model_sizes();

}  // namespace drape::lab
