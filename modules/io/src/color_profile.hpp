// Embedded colour profiles: the colours of a photo as sRGB, which everything in drape takes them for.
#pragma once

#include <optional>
#include <string_view>

#include "drape/geometry/image.hpp"
#include "picture_codec.hpp"

namespace drape::io {

enum class ProfileKind {
  none,        // no profile, or it is sRGB itself
  applied,     // the colours were converted
  not_applied  // damaged, or of a kind that is not read: other than RGB with a matrix and curves
};

struct SrgbPicture {
  Image8 rgb;
  ProfileKind kind = ProfileKind::none;
};

/// Converts an RGB image with an ICC profile of the matrix / TRC kind (ICC.1:2010, annex F.3) to sRGB (IEC
/// 61966-2-1); colours outside of it are clamped channel by channel. An image without a profile, with one
/// that is sRGB to half a byte step, or with one that is not read comes back as it is.
[[nodiscard]] SrgbPicture to_srgb(Image8 rgb, std::string_view icc);
/// The same for samples of 16 bit: in a wide space 8 bit would be too few. Nothing where to_srgb would give
/// an image back as it is.
[[nodiscard]] std::optional<Image16> to_srgb(const Image16& rgb, std::string_view icc);

}  // namespace drape::io
