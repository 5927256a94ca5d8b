// What a picture file says of itself before its pixels are decoded.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace drape::io {

enum class PictureFormat { jpeg, png, tiff, webp, bmp, pnm };

struct PictureHeader {
  PictureFormat format = PictureFormat::png;
  std::uint64_t width = 0;  // as stored, before any turning
  std::uint64_t height = 0;
  std::string_view exif;         // the TIFF structure with the EXIF tags; empty if there is none
  std::string icc;               // the colour profile; empty if there is none
  std::string damaged_icc_name;  // of a PNG's profile that could not be unpacked
};

/// Reads the header and checks that the file is whole where its structure tells (JPEG: ends with its end
/// marker; PNG: every chunk there with its checksum; PNM and BMP: as many bytes as the pixels take).
/// Error{input}: HEIC, AVIF and camera RAW by name with a converter, an unknown format, a truncated or
/// damaged file, a picture without pixels or with more than 2^28. The result refers to `bytes`.
[[nodiscard]] PictureHeader read_picture_header(const std::string& file, std::string_view bytes);

}  // namespace drape::io
