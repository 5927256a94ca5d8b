// Picture files that say that their colours are sRGB.
#pragma once

#include <string>

namespace drape::io {

/// The profile of sRGB (IEC 61966-2-1), as Little CMS makes it; always the same bytes.
[[nodiscard]] const std::string& srgb_profile();

/// With the chunk that calls the colours sRGB, right behind the header.
[[nodiscard]] std::string srgb_png(std::string png);
/// With the profile in an APP2 segment, behind JFIF's own, which is to come first.
[[nodiscard]] std::string srgb_jpeg(std::string jpeg);
/// With the profile as tag 34675. The first directory moves to the end of the file, where it has room for it.
[[nodiscard]] std::string srgb_tiff(std::string tiff);

}  // namespace drape::io
