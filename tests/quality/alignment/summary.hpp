// Many trials in one row.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trials.hpp"

namespace drape::lab {

/// The largest share that is not excluded with 95 % confidence when `count` of `n` were seen (Clopper and
/// Pearson 1934, one-sided); 1 for n = 0. For count = 0 about 3 / n.
[[nodiscard]] double upper_bound_95(int count, int n);

struct Row {
  std::string cell;
  std::string model;  // or the group of models
  std::vector<Trial> trials;
  bool pooled = false;  // a group's: its trials are in other rows too
};

void print_header();
void print_row(const Row& row);

/// Every failure of the row in a line of its own: what it was, and what the verdict said.
void print_failures(const Row& row);

/// The figures of the row's columns, and its failures.
[[nodiscard]] nlohmann::json to_json(const Row& row);

}  // namespace drape::lab
