// The few EXIF tags that matter to a photo (CIPA DC-008, "Exif 2.32"; TIFF 6.0).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drape::io {

struct Exif {
  int orientation = 1;  // 1..8, TIFF tag 274: where the stored picture's first row and column belong
  std::string make;
  std::string model;
  std::optional<double> focal_35mm;       // FocalLengthIn35mmFilm
  std::optional<double> focal_mm;         // FocalLength
  std::optional<double> plane_px_per_mm;  // FocalPlaneXResolution in FocalPlaneResolutionUnit
  std::optional<double> image_width;      // PixelXDimension: what the focal plane resolution refers to
};

/// Reads a TIFF structure. Never fails: what is damaged, missing or out of range stays unset.
[[nodiscard]] Exif read_exif(std::string_view tiff);

/// A TIFF with its orientation set to 1, so that a decoder which turns pictures by itself leaves it alone.
[[nodiscard]] std::string without_orientation(std::string tiff);

/// Focal length in pixels for a picture whose longer side is `longer_side_px`: from the 35 mm equivalent (the
/// film is 36 mm wide), else from the focal length and the focal plane's resolution. Nothing if neither is
/// there or the value makes no sense (under 0.1 or over 100 times the longer side).
[[nodiscard]] std::optional<double> focal_px(const Exif& exif, int width, int height);

/// Bytes as whole numbers of either byte order; nothing beyond the end.
class TiffBytes {
 public:
  /// Not valid() unless the bytes start with a TIFF header.
  explicit TiffBytes(std::string_view bytes);

  [[nodiscard]] bool valid() const { return valid_; }
  [[nodiscard]] std::optional<std::uint32_t> u16(std::uint64_t at) const;
  [[nodiscard]] std::optional<std::uint32_t> u32(std::uint64_t at) const;
  [[nodiscard]] std::string_view text(std::uint64_t at, std::uint64_t size) const;

  /// One entry of a directory (IFD): where its value lies, its type and count.
  struct Entry {
    std::uint32_t tag, type, count;
    std::uint64_t at;
  };
  /// Of the directory at `offset`, at most 512; those whose value is not within the bytes are left out.
  [[nodiscard]] std::vector<Entry> entries(std::uint64_t offset) const;
  /// The first value of an entry: a whole number or a ratio.
  [[nodiscard]] std::optional<double> number(const Entry& entry) const;
  /// All whole numbers of an entry.
  [[nodiscard]] std::vector<double> numbers(const Entry& entry) const;

 private:
  std::string_view bytes_;
  bool big_endian_ = false;
  bool valid_ = false;
};

}  // namespace drape::io
