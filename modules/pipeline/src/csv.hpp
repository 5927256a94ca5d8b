// Comma-separated values (RFC 4180).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace drape::pipeline {

struct CsvRow {
  int line = 0;  // from 1, where it starts
  std::vector<std::string> cells;
};

/// Quoted cells may hold commas, line ends and doubled quotes; rows without any text are left out. `source`
/// names the text in messages. Error{config} for a quote that is not closed.
[[nodiscard]] std::vector<CsvRow> parse_csv(std::string_view text, const std::string& source);

/// One cell, quoted where it must be.
[[nodiscard]] std::string csv_cell(const std::string& text);

}  // namespace drape::pipeline
