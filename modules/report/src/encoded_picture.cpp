#include "encoded_picture.hpp"

#include <cstddef>

namespace drape::report {
namespace {

// Big-endian, as both formats are.
int number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  unsigned value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return static_cast<int>(value);
}

std::optional<EncodedPicture> valid(EncodedPicture picture) {
  if (picture.width <= 0 || picture.height <= 0) return std::nullopt;
  return picture;
}

// PNG specification, section 11.2.2: the header chunk is the first.
std::optional<EncodedPicture> png(std::string_view bytes) {
  if (bytes.size() < 24 || bytes.substr(12, 4) != "IHDR") return std::nullopt;
  return valid({"image/png", number_at(bytes, 16, 4), number_at(bytes, 20, 4)});
}

// ITU-T T.81, B.2.2: the size is in the frame header, whose marker is one of SOF0..SOF15 (C4, C8 and CC are
// others).
std::optional<EncodedPicture> jpeg(std::string_view bytes) {
  for (std::size_t at = 2; at + 9 < bytes.size();) {
    if (bytes[at] != '\xFF') return std::nullopt;
    const int marker = number_at(bytes, at + 1, 1);
    if (marker == 0xFF) {
      ++at;  // fill byte
      continue;
    }
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame) return valid({"image/jpeg", number_at(bytes, at + 7, 2), number_at(bytes, at + 5, 2)});
    at += 2 + static_cast<std::size_t>(number_at(bytes, at + 2, 2));
  }
  return std::nullopt;
}

}  // namespace

std::optional<EncodedPicture> encoded_picture(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return png(bytes);
  if (bytes.starts_with("\xFF\xD8\xFF")) return jpeg(bytes);
  return std::nullopt;
}

}  // namespace drape::report
