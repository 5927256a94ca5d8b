// The look of the page.
#pragma once

#include <string_view>

namespace drape::report {

/// CSS: colours for light and dark, wide and narrow screens, print.
[[nodiscard]] std::string_view page_style();

}  // namespace drape::report
