// Photos and other pictures: the one door through which pixels come in.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "drape/geometry/deep_image.hpp"

namespace drape::io {

struct Photo {
  // Upright: EXIF orientation applied; 16 bit reduced to 8, after the profile; grey spread to 3 channels; an
  // embedded colour profile (ICC matrix and curves; in JPEG, TIFF and WebP) converted to sRGB.
  Image8 rgb;
  Image16 deep_rgb;  // the same before it is reduced, if asked for and the file has 16 bit; else empty
  Image8 alpha;      // 1 channel; empty if the file has none or is opaque everywhere
  // From EXIF: the focal length for 35 mm film (36 mm wide: the longer side), else the focal length and the
  // focal plane's resolution. Nothing if neither is there or makes sense.
  std::optional<double> focal_px_prior;
  std::string camera_model;  // from EXIF; empty if unknown
};

/// JPEG, PNG, TIFF, WebP, BMP, PNM. HEIC and camera RAW are refused by name, with a converter named.
/// Error{input} for a missing file, one that is no picture, has samples other than 8 or 16 bits, is truncated
/// (a JPEG without its end marker counts as such) or damaged, or has more than 2^28 pixels, which is known
/// before anything is decoded.
[[nodiscard]] Photo read_photo(const std::filesystem::path& file, bool keep_depth = false);

/// A mask or stencil: one channel, upright. 0 stays background, 255 object, 128 unknown; of any other picture
/// a value over 127 is object (so black-and-white masks of any depth work), and of one that holds nothing but
/// 0 and 1 in its own depth (labels), 1 is; alpha counts where the picture has one colour. Error{input} as
/// read_photo, and if its size is not width x height.
[[nodiscard]] Image8 read_stencil(const std::filesystem::path& file, int width, int height);

/// Width and height of the upright photo, from its header: Error{input} as read_photo, but nothing is
/// decoded.
struct ImageSize {
  int width = 0;
  int height = 0;
};
[[nodiscard]] ImageSize read_photo_size(const std::filesystem::path& file);

enum class Samples {
  srgb,    // colours; the file says so
  numbers  // of something else, as of a normal map
};

/// PNG or JPEG by extension (JPEG at the quality given, 1..100). 1, 3 or 4 channels; JPEG has no alpha and
/// leaves it out. Error{io}.
void write_image(const std::filesystem::path& file, const Image8& image, int jpeg_quality = 95);

/// The same into memory: format "png" or "jpg". What holds 3 or 4 channels of colours calls them sRGB, so
/// that viewers with other defaults show them right: a PNG by its chunk for that (PNG, third
/// edition, 11.3.2.5), a JPEG by a profile (ICC.1:2010, B.4).
[[nodiscard]] std::string encode_image(const Image8& image, const std::string& format, int jpeg_quality = 95,
                                       Samples samples = Samples::srgb);

/// TIFF of 16 bits a channel, RGB, packed without loss (LZW), with the profile of sRGB (ICC.1:2010, B.3).
/// Error{io}.
void write_tiff(const std::filesystem::path& file, const Image16& image);

}  // namespace drape::io
