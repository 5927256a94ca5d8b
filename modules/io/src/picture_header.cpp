#include "picture_header.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "exif.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

using namespace std::string_view_literals;

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;

std::uint64_t big(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}
std::uint64_t little(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

bool is_blank(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

Error truncated(const std::string& file, std::size_t byte) {
  return byte_error(file, byte, "the picture ends here: the file is truncated");
}

// --- pictures that are refused by name

void refuse_heif(const std::string& file, std::string_view bytes) {
  if (bytes.size() < 12 || bytes.substr(4, 4) != "ftyp"sv) return;
  const std::string_view brand = bytes.substr(8, 4);
  if (brand == "crx "sv)
    throw input_error(
        "{}: is a camera RAW file (CR3), which is not read: develop it first, e.g. with darktable-cli", file);
  const bool avif = brand == "avif"sv || brand == "avis"sv;
  throw input_error(
      "{}: is {} picture, which is not read: convert it first, e.g. \"heif-convert {} photo.png\"", file,
      avif ? "an AVIF" : "a HEIC", std::filesystem::path(file).filename().string());
}

void refuse_raw(const std::string& file, std::string_view bytes) {
  static constexpr std::array magics{"IIRO"sv, "IIRS"sv, "MMOR"sv, "IIU\0"sv, "FUJIFILMCCD-RAW"sv, "FOVb"sv};
  static constexpr std::array extensions{"cr2"sv, "cr3"sv, "crw"sv, "nef"sv, "nrw"sv, "arw"sv,
                                         "sr2"sv, "srf"sv, "dng"sv, "raf"sv, "orf"sv, "rw2"sv,
                                         "pef"sv, "srw"sv, "3fr"sv, "erf"sv, "kdc"sv, "dcr"sv,
                                         "mef"sv, "mos"sv, "iiq"sv, "rwl"sv, "x3f"sv};
  bool raw = std::any_of(magics.begin(), magics.end(),
                         [&](std::string_view magic) { return bytes.starts_with(magic); });
  const TiffBytes tiff(bytes);
  if (tiff.valid()) {
    const std::string ending = extension(file);
    raw = raw || bytes.substr(8, 2) == "CR"sv ||
          std::find(extensions.begin(), extensions.end(), ending) != extensions.end();
    for (const TiffBytes::Entry& entry : tiff.entries(tiff.u32(4).value_or(0)))
      raw = raw || entry.tag == 50706;  // DNGVersion
  }
  if (raw)
    throw input_error(
        "{}: is a camera RAW file, which is not read: develop it first, e.g. \"darktable-cli {} photo.png\"",
        file, std::filesystem::path(file).filename().string());
}

// --- JPEG (ITU-T T.81, annex B)

/// The first byte of the next marker (0xFF x) after entropy-coded data that starts at `at`.
std::size_t after_entropy_data(std::string_view bytes, std::size_t at) {
  while (at + 1 < bytes.size()) {
    const void* found = std::memchr(bytes.data() + at, 0xFF, bytes.size() - at - 1);
    if (found == nullptr) break;
    at = static_cast<std::size_t>(static_cast<const char*>(found) - bytes.data());
    const auto next = static_cast<unsigned char>(bytes[at + 1]);
    if (next != 0 && next != 0xFF && !(next >= 0xD0 && next <= 0xD7)) return at;
    at += next == 0xFF ? 1 : 2;
  }
  return bytes.size();
}

PictureHeader jpeg_header(const std::string& file, std::string_view bytes) {
  PictureHeader header{PictureFormat::jpeg, 0, 0, {}, {}, {}};
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    if (static_cast<unsigned char>(bytes[at]) != 0xFF)
      throw byte_error(file, at, "the JPEG is damaged: no marker here");
    if (marker == 0xFF) {  // filling
      ++at;
      continue;
    }
    if (marker == 0xD9) {
      if (header.width == 0) throw byte_error(file, at, "the JPEG ends without a picture");
      return header;
    }
    if (marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8)) {  // without a length
      at += 2;
      continue;
    }
    if (at + 4 > bytes.size()) break;
    const std::uint64_t length = big(bytes, at + 2, 2);
    if (length < 2) throw byte_error(file, at, "the JPEG is damaged: a segment of length {}", length);
    if (length > bytes.size() - at - 2) break;
    const std::string_view segment = bytes.substr(at + 4, length - 2);
    const bool frame = marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (frame && header.width == 0 && segment.size() >= 5) {
      header.height = big(segment, 1, 2);
      header.width = big(segment, 3, 2);
    }
    if (marker == 0xE1 && header.exif.empty() && segment.starts_with("Exif\0\0"sv))
      header.exif = segment.substr(6);
    // A profile may take several segments, each with its number and their count; they come in order.
    if (marker == 0xE2 && segment.starts_with("ICC_PROFILE\0"sv) && segment.size() > 14)
      header.icc += segment.substr(14);
    at += 2 + length;
    if (marker == 0xDA) at = after_entropy_data(bytes, at);
  }
  throw truncated(file, bytes.size());
}

// --- PNG (ISO/IEC 15948)

std::uint32_t crc32(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t c = i;
      for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xEDB88320U ^ (c >> 1) : c >> 1;
      t[i] = c;
    }
    return t;
  }();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) crc = table[(crc ^ static_cast<unsigned char>(byte)) & 0xFFU] ^ (crc >> 8);
  return crc ^ 0xFFFFFFFFU;
}

// A zlib stream, if it is whole and holds no more than a profile may.
std::optional<std::string> unpacked(std::string_view packed) {
  constexpr std::size_t most_bytes = std::size_t{1} << 24;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return std::nullopt;
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, &inflateEnd);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string bytes;
  std::array<char, 65536> piece{};
  for (int status = Z_OK; status != Z_STREAM_END;) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t made = piece.size() - stream.avail_out;
    if ((status != Z_OK && status != Z_STREAM_END) || (made == 0 && status == Z_OK)) return std::nullopt;
    bytes.append(piece.data(), made);
    if (bytes.size() > most_bytes) return std::nullopt;
  }
  return bytes;
}

// A name of up to 79 letters, its end, 0 for deflate, the packed profile (PNG, section 11.3.3.3).
void read_png_profile(std::string_view data, PictureHeader& header) {
  const std::size_t name_end = std::min<std::size_t>(data.find('\0'), 80);
  auto profile = name_end + 2 < data.size() && data[name_end] == '\0' && data[name_end + 1] == '\0'
                     ? unpacked(data.substr(name_end + 2))
                     : std::nullopt;
  if (profile && !profile->empty())
    header.icc = std::move(*profile);
  else
    header.damaged_icc_name = "\"" + std::string(data.substr(0, name_end)) + "\"";
}

PictureHeader png_header(const std::string& file, std::string_view bytes) {
  PictureHeader header{PictureFormat::png, 0, 0, {}, {}, {}};
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    const std::uint64_t length = big(bytes, at, 4);
    if (length > bytes.size() - at - 12) break;
    const std::string_view type = bytes.substr(at + 4, 4);
    const std::string_view data = bytes.substr(at + 8, length);
    if (crc32(bytes.substr(at + 4, length + 4)) != big(bytes, at + 8 + length, 4))
      throw byte_error(file, at, "the PNG is damaged: the checksum of a chunk is wrong");
    if ((type == "IHDR"sv) != (at == 8)) throw byte_error(file, at, "the PNG does not start with its header");
    if (type == "IHDR"sv && length >= 8) {
      header.width = big(data, 0, 4);
      header.height = big(data, 4, 4);
    }
    if (type == "eXIf"sv) header.exif = data;
    if (type == "iCCP"sv) read_png_profile(data, header);
    if (type == "IEND"sv) return header;
    at += 12 + length;
  }
  throw truncated(file, bytes.size());
}

// --- TIFF 6.0

PictureHeader tiff_header(const std::string& file, std::string_view bytes) {
  PictureHeader header{PictureFormat::tiff, 0, 0, bytes, {}, {}};
  const TiffBytes tiff(bytes);
  std::vector<double> offsets;
  std::vector<double> sizes;
  for (const TiffBytes::Entry& entry : tiff.entries(tiff.u32(4).value_or(0))) {
    const double value = tiff.number(entry).value_or(0);
    if (entry.tag == 256) header.width = static_cast<std::uint64_t>(value);
    if (entry.tag == 257) header.height = static_cast<std::uint64_t>(value);
    if (entry.tag == 273 || entry.tag == 324) offsets = tiff.numbers(entry);
    if (entry.tag == 34675) header.icc = tiff.text(entry.at, entry.count);
    if (entry.tag == 279 || entry.tag == 325) sizes = tiff.numbers(entry);
  }
  if (offsets.empty() || offsets.size() != sizes.size())
    throw input_error("{}: the TIFF is damaged or truncated: it does not say where its pixels are", file);
  for (std::size_t i = 0; i < offsets.size(); ++i)
    if (offsets[i] + sizes[i] > static_cast<double>(bytes.size())) throw truncated(file, bytes.size());
  return header;
}

// --- WebP (RFC 9649)

PictureHeader webp_header(const std::string& file, std::string_view bytes) {
  PictureHeader header{PictureFormat::webp, 0, 0, {}, {}, {}};
  if (little(bytes, 4, 4) + 8 > bytes.size()) throw truncated(file, bytes.size());
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::string_view type = bytes.substr(at, 4);
    const std::uint64_t length = little(bytes, at + 4, 4);
    if (length > bytes.size() - at - 8) throw truncated(file, bytes.size());
    const std::string_view data = bytes.substr(at + 8, length);
    if (type == "VP8X"sv && length >= 10) {
      header.width = little(data, 4, 3) + 1;
      header.height = little(data, 7, 3) + 1;
    } else if (type == "VP8 "sv && length >= 10 && header.width == 0) {
      header.width = little(data, 6, 2) & 0x3FFF;
      header.height = little(data, 8, 2) & 0x3FFF;
    } else if (type == "VP8L"sv && length >= 5 && header.width == 0) {
      const std::uint64_t bits = little(data, 1, 4);
      header.width = (bits & 0x3FFF) + 1;
      header.height = (bits >> 14 & 0x3FFF) + 1;
    } else if (type == "ICCP"sv) {
      header.icc = data;
    } else if (type == "EXIF"sv) {
      header.exif = data.starts_with("Exif\0\0"sv) ? data.substr(6) : data;
    }
    at += 8 + length + length % 2;
  }
  return header;
}

// --- BMP

PictureHeader bmp_header(const std::string& file, std::string_view bytes) {
  PictureHeader header{PictureFormat::bmp, 0, 0, {}, {}, {}};
  if (bytes.size() < 34) throw truncated(file, bytes.size());
  const bool old = little(bytes, 14, 4) == 12;
  const auto magnitude = [](std::uint64_t value) {
    return value >= 0x80000000U ? 0x100000000U - value : value;
  };
  header.width = old ? little(bytes, 18, 2) : magnitude(little(bytes, 18, 4));
  header.height = old ? little(bytes, 20, 2) : magnitude(little(bytes, 22, 4));
  const std::uint64_t bits = little(bytes, old ? 24 : 28, 2);
  const std::uint64_t compression = old ? 0 : little(bytes, 30, 4);
  if (bits > 32) throw byte_error(file, 28, "a BMP with {} bits a pixel", bits);
  // Run-length codes (1, 2) say nothing of their length here.
  if (compression != 1 && compression != 2 && header.width <= most_pixels && header.height <= most_pixels) {
    const std::uint64_t row = (header.width * bits + 31) / 32 * 4;
    const std::uint64_t pixels_at = little(bytes, 10, 4);
    if (pixels_at > bytes.size() || (row != 0 && header.height > (bytes.size() - pixels_at) / row))
      throw truncated(file, bytes.size());
  }
  return header;
}

// --- PNM (Netpbm's pbm, pgm, ppm)

PictureHeader pnm_header(const std::string& file, std::string_view bytes) {
  const int kind = bytes[1] - '0';
  std::size_t at = 2;
  const auto next_number = [&]() -> std::uint64_t {
    while (at < bytes.size() && (is_blank(bytes[at]) || bytes[at] == '#'))
      at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
    const std::size_t begin = at;
    while (at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9') ++at;
    const auto value = parse_integer(bytes.substr(begin, at - begin));
    if (!value) throw byte_error(file, begin, "the PNM header should have a number here");
    return static_cast<std::uint64_t>(*value);
  };
  PictureHeader header{PictureFormat::pnm, next_number(), next_number(), {}, {}, {}};
  const bool bits = kind == 1 || kind == 4;
  const std::uint64_t most = bits ? 1 : next_number();
  if (most == 0 || most > 65535)
    throw byte_error(file, at, "the largest value of a PNM is within 1 and 65535");
  ++at;
  if (header.width > most_pixels || header.height > most_pixels) return header;
  const std::uint64_t samples = header.width * (kind % 3 == 0 ? 3 : 1);
  // Text takes at least one digit a sample (and, but for bits, a separator).
  const std::uint64_t row = kind == 4   ? (header.width + 7) / 8
                            : kind > 3  ? samples * (most > 255 ? 2 : 1)
                            : kind == 1 ? samples
                                        : 2 * samples;
  const std::uint64_t left = bytes.size() - std::min(at, bytes.size()) + (kind < 4 ? 1 : 0);
  if (row != 0 && header.height > left / row) throw truncated(file, bytes.size());
  return header;
}

PictureHeader any_header(const std::string& file, std::string_view bytes) {
  if (bytes.starts_with("\xFF\xD8\xFF"sv)) return jpeg_header(file, bytes);
  if (bytes.starts_with("\x89PNG\r\n\x1A\n"sv)) return png_header(file, bytes);
  if (TiffBytes(bytes).valid()) return tiff_header(file, bytes);
  if (bytes.starts_with("RIFF"sv) && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP"sv)
    return webp_header(file, bytes);
  if (bytes.starts_with("BM"sv)) return bmp_header(file, bytes);
  if (bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' && is_blank(bytes[2]))
    return pnm_header(file, bytes);
  throw input_error("{}: is no picture that can be read (JPEG, PNG, TIFF, WebP, BMP, PNM)", file);
}

}  // namespace

PictureHeader read_picture_header(const std::string& file, std::string_view bytes) {
  if (bytes.empty()) throw input_error("{}: is empty", file);
  refuse_heif(file, bytes);
  refuse_raw(file, bytes);
  const PictureHeader header = any_header(file, bytes);
  if (header.width == 0 || header.height == 0) throw input_error("{}: the picture has no pixels", file);
  if (header.width > most_pixels || header.height > most_pixels || header.width * header.height > most_pixels)
    throw input_error("{}: the picture has {} x {} pixels; more than 2^28 are not read", file, header.width,
                      header.height);
  return header;
}

}  // namespace drape::io
