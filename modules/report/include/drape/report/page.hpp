// The page of a run: one HTML file that holds everything it shows.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace drape::report {

/// A PNG or JPEG file in memory, which the page embeds.
struct Picture {
  std::string title;
  std::string alt_text;  // what it shows, for those who do not see it
  std::string caption;   // what to look for in it; may be empty
  std::string png_or_jpeg_bytes;
  std::string key;  // by which the page's data names it; may be empty
};

struct Number {
  std::string name;        // "overlap"
  std::string value_text;  // "96.4"
  std::string unit;        // "%"; may be empty
  std::string meaning;     // one line; may be empty
};

enum class StageStatus { ran, reused, failed };

struct StageSection {
  std::string name;
  std::string summary;  // what the stage does, in one line
  StageStatus status = StageStatus::ran;
  double seconds = 0;         // that it took when it ran: in an earlier run, if it was reused
  double peak_memory_mb = 0;  // 0: not known
  std::vector<Number> numbers;
  std::vector<Picture> pictures;
  std::vector<std::string> warnings;
  std::vector<std::pair<std::string, std::string>> options;  // name and value of those that were changed
};

/// The model to be turned on the page, and what can be put right there.
struct ModelView {
  std::string glb_bytes;  // glTF 2.0; empty: there is no model to be turned
  std::string data_json;  // an object, as modules/stages/src/page_data.cpp makes it
};

enum class RunStatus { ok, review, failed };

struct RunPage {
  std::string title;  // the run's name
  RunStatus status = RunStatus::ok;
  std::vector<std::string> reasons;  // why it is not ok
  std::string started;               // ISO 8601
  double seconds = 0;                // of this run, as the user waited
  std::vector<Number> numbers;       // the few that matter most
  std::optional<ModelView> view;
  std::vector<Picture> pictures;     // photo, stencil, overlay, renders
  std::vector<StageSection> stages;  // in the order they run
  std::string command_line;          // makes the run again
  std::string config_text;
  std::vector<std::pair<std::string, std::string>> versions;  // of what, and which
};

/// The page as HTML 5 (well-formed XML too): no network, light and dark, for wide and narrow screens. Its one
/// script is there where there is a view; without scripts or WebGL everything else can be read all the same.
/// Every text is shown as it is, mark-up in it included; bytes that are no UTF-8 become U+FFFD. A picture
/// that is neither PNG nor JPEG is replaced by a line that says so.
[[nodiscard]] std::string render_page(const RunPage& page);

}  // namespace drape::report
