// Picture files made byte by byte: kinds that drape reads but does not write.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace drape::test {

template <class Number>
std::string raw(Number value, bool big_endian) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(value);
  return big_endian ? std::string(bytes.rbegin(), bytes.rend()) : std::string(bytes.begin(), bytes.end());
}

inline std::uint32_t crc32_of(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int k = 0; k < 8; ++k) crc = (crc & 1U) != 0 ? crc >> 1 ^ 0xEDB88320U : crc >> 1;
  }
  return ~crc;
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
  return raw(static_cast<std::uint32_t>(data.size()), true) + type + data + raw(crc32_of(type + data), true);
}

/// zlib's format with one stored block (RFC 1950, 1951).
inline std::string zlib_stored(const std::string& data) {
  std::uint32_t a = 1, b = 0;
  for (const char byte : data) {
    a = (a + static_cast<unsigned char>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  const auto size = static_cast<std::uint16_t>(data.size());
  return std::string("\x78\x01\x01") + raw(size, false) + raw(static_cast<std::uint16_t>(~size), false) +
         data + raw(b << 16 | a, true);
}

/// `rows`: the packed samples of each row, without the filter byte. `extra`: chunks before the pixels.
inline std::string png_file(std::uint32_t width, std::uint32_t height, int bits, int color_type,
                            const std::vector<std::string>& rows, const std::string& extra = {}) {
  std::string data;
  for (const std::string& row : rows) data += '\0' + row;
  return "\x89PNG\r\n\x1A\n" +
         png_chunk("IHDR", raw(width, true) + raw(height, true) + static_cast<char>(bits) +
                               static_cast<char>(color_type) + std::string(3, '\0')) +
         extra + png_chunk("IDAT", zlib_stored(data)) + png_chunk("IEND", "");
}

/// A TIFF directory, also the body of EXIF. Values longer than four bytes go behind the directory.
class TiffBuilder {
 public:
  explicit TiffBuilder(bool big_endian) : big_(big_endian) {}

  void add_short(std::uint16_t tag, std::uint16_t value) { add(tag, 3, 1, raw(value, big_)); }
  void add_shorts(std::uint16_t tag, const std::vector<std::uint16_t>& values) {
    std::string bytes;
    for (const std::uint16_t value : values) bytes += raw(value, big_);
    add(tag, 3, static_cast<std::uint32_t>(values.size()), bytes);
  }
  void add_long(std::uint16_t tag, std::uint32_t value) { add(tag, 4, 1, raw(value, big_)); }
  void add_ratio(std::uint16_t tag, std::uint32_t above, std::uint32_t below) {
    add(tag, 5, 1, raw(above, big_) + raw(below, big_));
  }
  void add_undefined(std::uint16_t tag, const std::string& bytes) {
    add(tag, 7, static_cast<std::uint32_t>(bytes.size()), bytes);
  }
  void add_text(std::uint16_t tag, const std::string& text) {
    add(tag, 2, static_cast<std::uint32_t>(text.size() + 1), text + '\0');
  }
  /// EXIF's own directory, behind this one.
  void add_directory(std::uint16_t tag, const TiffBuilder& directory) {
    directories_.emplace_back(tag, directory);
  }
  /// The pixels, behind the directory, named by StripOffsets and StripByteCounts.
  void add_pixels(const std::string& pixels) { pixels_ = pixels; }

  [[nodiscard]] std::string bytes() const {
    const std::string head = (big_ ? std::string("MM") : std::string("II")) + raw(std::uint16_t{42}, big_) +
                             raw(std::uint32_t{8}, big_);
    return head + body(8);
  }

 private:
  struct Entry {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::string value;
  };

  void add(std::uint16_t tag, std::uint16_t type, std::uint32_t count, const std::string& value) {
    entries_.push_back({tag, type, count, value});
  }

  /// The directory as it is at `offset`.
  [[nodiscard]] std::string body(std::uint32_t offset) const {
    const std::size_t count = entries_.size() + directories_.size() + (pixels_.empty() ? 0 : 2);
    const auto after = static_cast<std::uint32_t>(offset + 2 + 12 * count + 4);
    std::string table = raw(static_cast<std::uint16_t>(count), big_);
    std::string tail;
    const auto here = [&] { return static_cast<std::uint32_t>(after + tail.size()); };
    const auto put = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t values, std::string value) {
      table += raw(tag, big_) + raw(type, big_) + raw(values, big_);
      if (value.size() > 4) {
        const std::string where = raw(here(), big_);
        tail += value;
        value = where;
      }
      table += value + std::string(4 - value.size(), '\0');
    };
    for (const Entry& entry : entries_) put(entry.tag, entry.type, entry.count, entry.value);
    for (const auto& [tag, directory] : directories_) {
      const std::uint32_t where = here();
      tail += directory.body(where);
      put(tag, 4, 1, raw(where, big_));
    }
    if (!pixels_.empty()) {
      const std::uint32_t where = here();
      tail += pixels_;
      put(273, 4, 1, raw(where, big_));
      put(279, 4, 1, raw(static_cast<std::uint32_t>(pixels_.size()), big_));
    }
    return table + std::string(4, '\0') + tail;
  }

  bool big_;
  std::vector<Entry> entries_;
  std::vector<std::pair<std::uint16_t, TiffBuilder>> directories_;
  std::string pixels_;
};

/// A JPEG with an EXIF segment behind its start marker.
inline std::string with_exif(const std::string& jpeg, const std::string& tiff) {
  const std::string data = std::string("Exif\0\0", 6) + tiff;
  return jpeg.substr(0, 2) + "\xFF\xE1" + raw(static_cast<std::uint16_t>(data.size() + 2), true) + data +
         jpeg.substr(2);
}

}  // namespace drape::test
