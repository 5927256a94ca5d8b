// What fuzzing and its replay both call.
#pragma once

#include <cstdlib>
#include <string>
#include <string_view>

#include "drape/base/error.hpp"
#include "drape/base/log.hpp"
#include "drape/io/scan_files.hpp"

namespace drape::test {

/// Reads the bytes as the scan file `name`, whole and thinned. They may be refused as bad input; whatever
/// else happens (another exception, a crash, no end) is a finding. Returns whether they were read.
inline bool read_as_scan(const std::string& name, std::string_view bytes) {
  log::set_console_level(log::Level::warning);
  io::ScanReadOptions options;
  options.depth = io::DepthCamera{{500, 500}, {}, 1000, false};
  bool read = true;
  for (const std::size_t most_points : {0U, 2U}) {
    options.most_points = most_points;
    try {
      for (const RangeScan& scan : io::parse_scans(name, bytes, options))
        if (scan.grid)
          for (const std::int32_t cell : scan.grid->cells)
            if (cell >= static_cast<std::int64_t>(scan.cloud.size())) std::abort();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::input) throw;
      read = false;
    }
  }
  return read;
}

}  // namespace drape::test
