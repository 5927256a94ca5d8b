#include "srgb_tags.hpp"

#include <lcms2.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "drape/base/error.hpp"
#include "exif.hpp"

namespace drape::io {
namespace {

std::string bytes_of(std::uint32_t number, std::size_t size, bool big_endian) {
  std::string bytes;
  for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(number >> 8 * i & 0xFFU);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string made_profile() {
  const std::unique_ptr<void, cmsBool (*)(cmsHPROFILE)> profile(cmsCreate_sRGBProfile(), &cmsCloseProfile);
  cmsUInt32Number size = 0;
  if (!profile || !cmsSaveProfileToMem(profile.get(), nullptr, &size))
    throw Error(ErrorCode::bug, "the colour profile of sRGB cannot be made");
  std::string bytes(size, '\0');
  cmsSaveProfileToMem(profile.get(), bytes.data(), &size);
  // When it was made (ICC.1:2010, 7.2.8) is of no use, and would make files differ.
  constexpr std::size_t date_at = 24;
  constexpr std::size_t date_size = 12;
  std::fill_n(bytes.begin() + date_at, date_size, '\0');
  return bytes;
}

}  // namespace

const std::string& srgb_profile() {
  static const std::string profile = made_profile();
  return profile;
}

std::string srgb_png(std::string png) {
  constexpr std::size_t behind_header = 8 + 25;
  constexpr char perceptual = 0;
  const std::string body = std::string("sRGB") + perceptual;
  const auto checksum = static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
  return png.insert(behind_header, bytes_of(1, 4, true) + body + bytes_of(checksum, 4, true));
}

std::string srgb_jpeg(std::string jpeg) {
  const std::string data = std::string("ICC_PROFILE\0\1\1", 14) + srgb_profile();
  const std::string segment =
      "\xFF\xE2" + bytes_of(static_cast<std::uint32_t>(data.size() + 2), 2, true) + data;
  std::size_t at = 2;
  if (jpeg.compare(2, 2, "\xFF\xE0") == 0)
    at += 2 + 256 * static_cast<std::size_t>(static_cast<unsigned char>(jpeg[4])) +
          static_cast<unsigned char>(jpeg[5]);
  return jpeg.insert(at, segment);
}

std::string srgb_tiff(std::string tiff) {
  constexpr std::uint32_t profile_tag = 34675;
  constexpr std::uint32_t undefined = 7;
  const bool big = tiff.front() == 'M';
  const TiffBytes old(tiff);
  const std::uint64_t directory = old.u32(4).value_or(0);
  const std::uint32_t count = old.u16(directory).value_or(0);
  const auto add = [&](std::uint32_t number, std::size_t size) { return bytes_of(number, size, big); };
  std::string behind = tiff.size() % 2 == 0 ? "" : std::string(1, '\0');
  const auto profile_at = static_cast<std::uint32_t>(tiff.size() + behind.size());
  behind += srgb_profile();
  if (behind.size() % 2 != tiff.size() % 2) behind += '\0';
  const auto directory_at = static_cast<std::uint32_t>(tiff.size() + behind.size());
  // Entries are sorted by tag.
  const std::string entry = add(profile_tag, 2) + add(undefined, 2) +
                            add(static_cast<std::uint32_t>(srgb_profile().size()), 4) + add(profile_at, 4);
  behind += add(count + 1, 2);
  bool placed = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t at = directory + 2 + 12 * std::uint64_t{i};
    if (!placed && old.u16(at).value_or(0) > profile_tag) {
      behind += entry;
      placed = true;
    }
    behind += old.text(at, 12);
  }
  if (!placed) behind += entry;
  behind += add(0, 4);  // no other picture
  tiff.replace(4, 4, add(directory_at, 4));
  return tiff + behind;
}

}  // namespace drape::io
