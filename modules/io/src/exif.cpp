#include "exif.hpp"

#include <algorithm>
#include <cmath>

namespace drape::io {
namespace {

// TIFF 6.0 and Exif 2.32 tags.
constexpr std::uint32_t tag_make = 271, tag_model = 272, tag_orientation = 274, tag_exif_directory = 34665,
                        tag_focal_length = 37386, tag_pixel_x_dimension = 40962,
                        tag_plane_x_resolution = 41486, tag_plane_unit = 41488, tag_focal_35mm = 41989;

std::uint64_t size_of_type(std::uint32_t type) {
  switch (type) {
    case 1:
    case 2:
    case 6:
    case 7:
      return 1;  // byte, text, signed byte, undefined
    case 3:
    case 8:
      return 2;  // short
    case 4:
    case 9:
    case 11:
    case 13:
      return 4;  // long, float, directory
    case 5:
    case 10:
    case 12:
      return 8;  // ratio, double
    default:
      return 0;
  }
}

/// Printable text up to the first NUL, without blanks at its end.
std::string clean(std::string_view text) {
  std::string kept(text.substr(0, text.find('\0')).substr(0, 100));
  for (char& c : kept)
    if (c < ' ' || c > '~') c = ' ';
  kept.erase(kept.find_last_not_of(' ') + 1);
  return kept;
}

std::optional<double> millimetres_of_unit(double unit) {
  if (unit == 2) return 25.4;
  if (unit == 3) return 10.0;
  if (unit == 4) return 1.0;
  return std::nullopt;
}

void read_camera_tags(const TiffBytes& tiff, std::uint64_t directory, Exif& exif) {
  std::optional<double> resolution;
  double unit = 2;  // inches, by the standard, where the file is silent
  const auto positive = [](std::optional<double> value) {
    return value && std::isfinite(*value) && *value > 0 ? value : std::nullopt;
  };
  for (const TiffBytes::Entry& entry : tiff.entries(directory)) {
    const auto value = positive(tiff.number(entry));
    if (entry.tag == tag_focal_length) exif.focal_mm = value;
    if (entry.tag == tag_focal_35mm) exif.focal_35mm = value;
    if (entry.tag == tag_pixel_x_dimension) exif.image_width = value;
    if (entry.tag == tag_plane_x_resolution) resolution = value;
    if (entry.tag == tag_plane_unit) unit = value.value_or(2);
  }
  if (const auto mm = millimetres_of_unit(unit); mm && resolution) exif.plane_px_per_mm = *resolution / *mm;
}

}  // namespace

TiffBytes::TiffBytes(std::string_view bytes) : bytes_(bytes) {
  if (bytes.size() < 8) return;
  big_endian_ = bytes.starts_with("MM");
  valid_ = (big_endian_ || bytes.starts_with("II")) && u16(2) == 42U;
}

std::optional<std::uint32_t> TiffBytes::u16(std::uint64_t at) const {
  if (at > bytes_.size() || bytes_.size() - at < 2) return std::nullopt;
  const auto byte = [&](std::uint64_t i) {
    return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes_[at + i]));
  };
  return big_endian_ ? byte(0) << 8 | byte(1) : byte(1) << 8 | byte(0);
}

std::optional<std::uint32_t> TiffBytes::u32(std::uint64_t at) const {
  const auto first = u16(at);
  const auto second = u16(at + 2);
  if (!first || !second) return std::nullopt;
  return big_endian_ ? *first << 16 | *second : *second << 16 | *first;
}

std::string_view TiffBytes::text(std::uint64_t at, std::uint64_t size) const {
  return at > bytes_.size() ? std::string_view() : bytes_.substr(at, size);
}

std::vector<TiffBytes::Entry> TiffBytes::entries(std::uint64_t offset) const {
  std::vector<Entry> found;
  const std::uint32_t count = std::min(u16(offset).value_or(0), 512U);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t at = offset + 2 + std::uint64_t{12} * i;
    const auto values = u32(at + 8);
    if (!values) break;
    Entry entry{*u16(at), *u16(at + 2), *u32(at + 4), at + 8};
    const std::uint64_t size = size_of_type(entry.type) * entry.count;
    if (size > 4) entry.at = *values;
    if (size > 0 && entry.at <= bytes_.size() && size <= bytes_.size() - entry.at) found.push_back(entry);
  }
  return found;
}

std::optional<double> TiffBytes::number(const Entry& entry) const {
  const auto as_double = [](std::optional<std::uint32_t> value) {
    return value ? std::optional<double>(*value) : std::nullopt;
  };
  switch (entry.type) {
    case 1:
      return static_cast<double>(static_cast<unsigned char>(bytes_[entry.at]));
    case 3:
      return as_double(u16(entry.at));
    case 4:
    case 13:
      return as_double(u32(entry.at));
    case 5: {
      const auto above = u32(entry.at);
      const auto below = u32(entry.at + 4);
      if (!above || !below || *below == 0) return std::nullopt;
      return static_cast<double>(*above) / *below;
    }
    default:
      return std::nullopt;
  }
}

std::vector<double> TiffBytes::numbers(const Entry& entry) const {
  std::vector<double> values;
  const std::uint64_t size = size_of_type(entry.type);
  for (std::uint64_t i = 0; i < entry.count; ++i) {
    const auto value = size == 2 ? u16(entry.at + 2 * i) : size == 4 ? u32(entry.at + 4 * i) : std::nullopt;
    if (!value) break;
    values.push_back(*value);
  }
  return values;
}

Exif read_exif(std::string_view bytes) {
  Exif exif;
  const TiffBytes tiff(bytes);
  if (!tiff.valid()) return exif;
  for (const TiffBytes::Entry& entry : tiff.entries(tiff.u32(4).value_or(0))) {
    if (entry.tag == tag_make && entry.type == 2) exif.make = clean(tiff.text(entry.at, entry.count));
    if (entry.tag == tag_model && entry.type == 2) exif.model = clean(tiff.text(entry.at, entry.count));
    const auto value = tiff.number(entry);
    if (entry.tag == tag_orientation && value && *value >= 1 && *value <= 8)
      exif.orientation = static_cast<int>(*value);
    if (entry.tag == tag_exif_directory && value)
      read_camera_tags(tiff, static_cast<std::uint64_t>(*value), exif);
  }
  return exif;
}

std::string without_orientation(std::string bytes) {
  const TiffBytes tiff(bytes);
  if (!tiff.valid()) return bytes;
  const bool big_endian = bytes.front() == 'M';
  std::vector<std::pair<std::size_t, std::size_t>> places;  // and sizes
  for (const TiffBytes::Entry& entry : tiff.entries(tiff.u32(4).value_or(0)))
    if (entry.tag == tag_orientation && entry.count == 1)
      places.emplace_back(entry.at, size_of_type(entry.type));
  for (const auto& [at, size] : places) {
    bytes.replace(at, size, size, '\0');
    bytes[big_endian ? at + size - 1 : at] = 1;
  }
  return bytes;
}

std::optional<double> focal_px(const Exif& exif, int width, int height) {
  const double longer = std::max(width, height);
  std::optional<double> focal;
  if (exif.focal_35mm) {
    focal = *exif.focal_35mm / 36.0 * longer;
  } else if (exif.focal_mm && exif.plane_px_per_mm) {
    // The resolution refers to the picture as taken: a smaller copy has fewer pixels to the millimetre.
    const double shrunk = exif.image_width ? width / *exif.image_width : 1.0;
    focal = *exif.focal_mm * *exif.plane_px_per_mm * shrunk;
  }
  if (focal && !(*focal >= 0.1 * longer && *focal <= 100 * longer)) return std::nullopt;
  return focal;
}

}  // namespace drape::io
