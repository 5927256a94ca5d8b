// Text as HTML.
#pragma once

#include <string>
#include <string_view>

namespace drape::report {

/// Safe between tags and inside double-quoted attributes, in HTML and in XML: & < > " ' are replaced, what is
/// no UTF-8 and control characters become U+FFFD, carriage returns are dropped.
[[nodiscard]] std::string escaped(std::string_view text);

/// RFC 4648.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace drape::report
