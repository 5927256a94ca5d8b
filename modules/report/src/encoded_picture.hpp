// What kind of picture encoded bytes hold.
#pragma once

#include <optional>
#include <string_view>

namespace drape::report {

struct EncodedPicture {
  std::string_view media_type;  // "image/png" or "image/jpeg"
  int width = 0;
  int height = 0;
};

/// From the header; nothing if the bytes are neither PNG nor JPEG or state no size.
[[nodiscard]] std::optional<EncodedPicture> encoded_picture(std::string_view bytes);

}  // namespace drape::report
