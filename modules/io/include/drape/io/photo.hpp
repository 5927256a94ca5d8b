// Photos and other pictures: the one door through which pixels come in.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drape/geometry/image.hpp"

namespace drape::io {

struct Photo {
  Image8 rgb;    // upright: EXIF orientation applied; 16 bit reduced to 8; grey spread to 3 channels
  Image8 alpha;  // 1 channel; empty if the file has none or is opaque everywhere
  std::optional<double>
      focal_px_prior;        // from EXIF (focal length in 35 mm, or focal length and focal plane resolution)
  std::string camera_model;  // from EXIF; empty if unknown
};

/// JPEG, PNG, TIFF, WebP, BMP, PNM. HEIC and camera RAW are refused by name, with a converter named.
/// Error{input} for a missing file, one that is no picture, is damaged, or has more than 2^28 pixels.
[[nodiscard]] Photo read_photo(const std::filesystem::path& file);

/// A mask or stencil: one channel, upright. 0 stays background, 255 object, 128 unknown; of any other picture
/// a value over 127 is object (so black-and-white masks of any depth work); alpha counts where the picture
/// has one colour. Error{input} if its size is not width x height.
[[nodiscard]] Image8 read_stencil(const std::filesystem::path& file, int width, int height);

/// Width and height of the upright photo.
struct ImageSize {
  int width = 0;
  int height = 0;
};
[[nodiscard]] ImageSize read_photo_size(const std::filesystem::path& file);

/// PNG or JPEG by extension (JPEG at the quality given, 1..100). 1, 3 or 4 channels. Error{io}.
void write_image(const std::filesystem::path& file, const Image8& image, int jpeg_quality = 95);

/// The same into memory: format "png" or "jpg".
[[nodiscard]] std::string encode_image(const Image8& image, const std::string& format, int jpeg_quality = 95);

}  // namespace drape::io
