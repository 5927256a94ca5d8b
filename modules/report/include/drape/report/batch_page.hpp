// The page of a batch: one row for each object.
#pragma once

#include <string>
#include <vector>

#include "drape/report/page.hpp"

namespace drape::report {

struct BatchRow {
  std::string object;
  std::string status;   // ok, review, failed, missing
  std::string message;  // why it is not ok
  std::string stage;    // that failed
  std::string ran;      // stages that were made, not reused
  double seconds = 0;
  double peak_memory_mb = 0;
  std::string link;               // relative address of the object's page; empty: it has none
  std::string png_or_jpeg_bytes;  // small picture of it; may be empty
};

struct BatchPage {
  std::string title;
  std::string facts;           // one line
  std::vector<BatchRow> rows;  // in the order that they are shown at first
  std::string apply_command;   // that makes use of the downloaded fixes.yaml
};

/// HTML 5 in one file, like render_page; sorted, searched and put right with its one script, and a plain
/// table without it.
[[nodiscard]] std::string render_batch(const BatchPage& page);

}  // namespace drape::report
