// The parts that a page is put together from. Every function gives well-formed HTML.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drape/report/page.hpp"

namespace drape::report {

/// From the document type to the end of <head>. `style` comes after that of all pages; `script_source`: by
/// what the security policy names the page's one script; empty: it has none.
[[nodiscard]] std::string page_head(std::string_view title, std::string_view style,
                                    const std::string& script_source);

[[nodiscard]] std::string status_pill(RunStatus status);
[[nodiscard]] std::string status_pill(StageStatus status);
/// The name of the state as a CSS class.
[[nodiscard]] std::string_view status_class(RunStatus status);
[[nodiscard]] std::string_view status_class(StageStatus status);

/// A framed list under a heading word; nothing without lines.
[[nodiscard]] std::string note(std::string_view heading, const std::vector<std::string>& lines, bool failed);

[[nodiscard]] std::string number_tiles(const std::vector<Number>& numbers);
[[nodiscard]] std::string number_table(const std::vector<Number>& numbers);

/// A grid of figures whose ids start with `id`; nothing without pictures. `large`: fewer in a row.
[[nodiscard]] std::string picture_grid(const std::vector<Picture>& pictures, std::string_view id, bool large);

[[nodiscard]] std::string option_table(const std::vector<std::pair<std::string, std::string>>& options);
[[nodiscard]] std::string time_table(const RunPage& page);

}  // namespace drape::report
