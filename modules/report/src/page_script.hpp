// The scripts of the pages, built from modules/report/page/src by scripts/build_page.
#pragma once

#include <string>
#include <string_view>

namespace drape::report {

/// Of a batch's page: sorting, finding, fixes.
[[nodiscard]] std::string_view batch_page_script();

/// Of a run's page: the view in three dimensions and mending; three.js is in it (MIT; its notice too).
[[nodiscard]] std::string_view run_page_script();

/// A script element with the source that a content security policy names it by ('sha256-...').
struct ScriptElement {
  std::string html;
  std::string policy_source;
};
[[nodiscard]] ScriptElement script_element(std::string_view script);

/// JSON that is safe inside a script element, in HTML and in XML.
[[nodiscard]] std::string json_in_script(std::string_view json);

}  // namespace drape::report
