#include "drape/io/photo.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "color_profile.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "exif.hpp"
#include "picture_codec.hpp"
#include "picture_header.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

/// The stored picture turned upright. EXIF's orientations (CIPA DC-008, tag 274): 1 as it is, 2 mirrored left
/// to right, 3 by half a turn, 4 mirrored top to bottom, 5 transposed, 6 by a quarter turn clockwise, 7
/// transposed across the other diagonal, 8 by a quarter turn counter-clockwise.
template <class Sample>
Image<Sample> upright(const Image<Sample>& stored, int orientation) {
  if (orientation == 1) return stored;
  const int w = stored.width() - 1;
  const int h = stored.height() - 1;
  const bool turned = orientation >= 5;
  Image<Sample> image(turned ? stored.height() : stored.width(), turned ? stored.width() : stored.height(),
                      stored.channels());
  const auto source = [&](int x, int y) -> std::pair<int, int> {
    switch (orientation) {
      case 2:
        return {w - x, y};
      case 3:
        return {w - x, h - y};
      case 4:
        return {x, h - y};
      case 5:
        return {y, x};
      case 6:
        return {y, h - x};
      case 7:
        return {w - y, h - x};
      default:
        return {w - y, x};
    }
  };
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const auto [sx, sy] = source(x, y);
      for (int c = 0; c < image.channels(); ++c) image.at(x, y, c) = stored.at(sx, sy, c);
    }
  return image;
}

/// Red, green and blue of any picture; grey is spread.
Image8 rgb_of(const Image8& image) {
  if (image.channels() == 3) return image;
  Image8 rgb(image.width(), image.height(), 3);
  const bool grey = image.channels() == 1;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < 3; ++c) rgb.at(x, y, c) = image.at(x, y, grey ? 0 : c);
  return rgb;
}

/// Empty if there is none, or it is opaque everywhere.
Image8 alpha_of(const Image8& image) {
  if (image.channels() != 4) return {};
  Image8 alpha(image.width(), image.height(), 1);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) alpha.at(x, y) = image.at(x, y, 3);
  const bool opaque =
      std::all_of(alpha.data().begin(), alpha.data().end(), [](std::uint8_t a) { return a == 255; });
  return opaque ? Image8() : alpha;
}

bool one_color(const Image8& image) {
  const int channels = std::min(image.channels(), 3);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      for (int c = 0; c < channels; ++c)
        if (image.at(x, y, c) != image.at(0, 0, c)) return false;
  return true;
}

/// One channel: alpha where the picture has one colour, else its luma (ITU-R BT.601, rounded).
Image8 grey_of(const Image8& image) {
  if (image.channels() == 1) return image;
  if (image.channels() == 4 && one_color(image)) {
    const Image8 alpha = alpha_of(image);
    if (!alpha.empty()) return alpha;
  }
  Image8 grey(image.width(), image.height(), 1);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      grey.at(x, y) = static_cast<std::uint8_t>(
          (299 * image.at(x, y, 0) + 587 * image.at(x, y, 1) + 114 * image.at(x, y, 2) + 500) / 1000);
  return grey;
}

struct Opened {
  DecodedPicture picture;
  Exif exif;
  PictureHeader header;
};

Opened opened(const std::filesystem::path& file, bool keep_depth = false) {
  const std::string name = file.string();
  const std::string bytes = read_file(file);
  Opened result;
  result.header = read_picture_header(name, bytes);
  result.exif = read_exif(result.header.exif);
  // OpenCV turns TIFFs by their tag, and them alone.
  const bool tiff = result.header.format == PictureFormat::tiff;
  result.picture = decode_picture(name, tiff ? without_orientation(bytes) : bytes,
                                  keep_depth || !result.header.icc.empty());
  result.header.exif = {};
  const Image8& pixels = result.picture.pixels;
  if (static_cast<std::uint64_t>(pixels.width()) != result.header.width ||
      static_cast<std::uint64_t>(pixels.height()) != result.header.height)
    throw input_error("{}: the picture is damaged: its header says {} x {} pixels, its data {} x {}", name,
                      result.header.width, result.header.height, pixels.width(), pixels.height());
  return result;
}

void tell_profile(const std::filesystem::path& file, const PictureHeader& header, ProfileKind kind) {
  const std::string& damaged = header.damaged_icc_name;
  if (kind == ProfileKind::applied) log::info("{}: its colour profile is converted to sRGB", file.string());
  if (!damaged.empty())
    log::warn("{}: its colour profile {} is damaged and not applied: its colours are taken for sRGB",
              file.string(), shown(damaged));
  else if (kind == ProfileKind::not_applied)
    log::warn("{}: its colour profile is not applied: convert the photo to sRGB if its colours matter",
              file.string());
}

}  // namespace

Photo read_photo(const std::filesystem::path& file, bool keep_depth) {
  Opened photo = opened(file, keep_depth);
  const Image8 pixels = upright(photo.picture.pixels, photo.exif.orientation);
  Photo result;
  SrgbPicture colors;
  Image16& deep = photo.picture.deep_rgb;
  if (auto converted = deep.empty() ? std::nullopt : to_srgb(deep, photo.header.icc)) {
    deep = *std::move(converted);
    colors = {upright(bytes_from_deep(deep), photo.exif.orientation), ProfileKind::applied};
  } else {
    colors = to_srgb(rgb_of(pixels), photo.header.icc);
  }
  tell_profile(file, photo.header, colors.kind);
  result.rgb = std::move(colors.rgb);
  if (keep_depth && !deep.empty()) result.deep_rgb = upright(deep, photo.exif.orientation);
  result.alpha = alpha_of(pixels);
  result.focal_px_prior =
      focal_px(photo.exif, static_cast<int>(photo.header.width), static_cast<int>(photo.header.height));
  const std::string& make = photo.exif.make;
  const std::string& model = photo.exif.model;
  result.camera_model =
      make.empty() || model.starts_with(make) ? model : make + (model.empty() ? "" : " ") + model;
  return result;
}

Image8 read_stencil(const std::filesystem::path& file, int width, int height) {
  const Opened mask = opened(file);
  Image8 grey = grey_of(upright(mask.picture.pixels, mask.exif.orientation));
  if (grey.width() != width || grey.height() != height)
    throw input_error("{}: has {} x {} pixels, but its photo has {} x {}", file.string(), grey.width(),
                      grey.height(), width, height);
  const bool three_values = std::all_of(grey.data().begin(), grey.data().end(), [](std::uint8_t v) {
    return v == stencil::background || v == stencil::unknown || v == stencil::object;
  });
  if (three_values) return grey;
  const std::uint8_t limit = mask.picture.only_zeros_and_ones ? 0 : 127;
  for (std::uint8_t& value : grey.data()) value = value > limit ? stencil::object : stencil::background;
  return grey;
}

ImageSize read_photo_size(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  const PictureHeader header = read_picture_header(file.string(), bytes);
  const bool turned = read_exif(header.exif).orientation >= 5;
  const ImageSize stored{static_cast<int>(header.width), static_cast<int>(header.height)};
  return turned ? ImageSize{stored.height, stored.width} : stored;
}

}  // namespace drape::io
