#include "e57_file.hpp"

#include <array>
#include <optional>

#include "byte_fields.hpp"
#include "drape/base/numbers.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

constexpr std::uint64_t header_bytes = 48;
constexpr std::uint64_t checksum_bytes = 4;

/// CRC-32C (Castagnoli), as iSCSI has it: RFC 3720, B.4.
std::uint32_t crc32c(std::string_view bytes) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> entries{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value & 1U) != 0 ? value >> 1 ^ 0x82F63B78U : value >> 1;
      entries[i] = value;
    }
    return entries;
  }();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) crc = crc >> 8 ^ table[(crc ^ static_cast<unsigned char>(byte)) & 255U];
  return ~crc;
}

}  // namespace

E57Pages::E57Pages(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {
  if (bytes.size() < header_bytes || !bytes.starts_with("ASTM-E57"))
    throw byte_error(file, 0, "is no E57 file: it does not start with ASTM-E57 and a header of {} bytes",
                     header_bytes);
  const auto major = load<std::uint32_t>(bytes, 8);
  const auto length = load<std::uint64_t>(bytes, 16);
  xml_physical_ = load<std::uint64_t>(bytes, 24);
  xml_size_ = load<std::uint64_t>(bytes, 32);
  page_size_ = load<std::uint64_t>(bytes, 40);
  if (major != 1) throw byte_error(file, 8, "E57 version {} is not known (1 is)", major);
  if (page_size_ < 64 || page_size_ > (1U << 20))
    throw byte_error(file, 40, "{} is no page size", page_size_);
  if (length != bytes.size())
    throw byte_error(file, 16, "the header claims {} bytes, but the file has {}", length, bytes.size());
  if (length % page_size_ != 0)
    throw byte_error(file, 16, "{} bytes are no whole pages of {}", length, page_size_);
}

std::uint64_t E57Pages::logical(std::uint64_t physical) const {
  return physical / page_size_ * (page_size_ - checksum_bytes) + physical % page_size_;
}

std::uint64_t E57Pages::physical(std::uint64_t logical) const {
  const std::uint64_t payload = page_size_ - checksum_bytes;
  return logical / payload * page_size_ + logical % payload;
}

std::uint64_t E57Pages::size() const {
  return bytes_.size() / page_size_ * (page_size_ - checksum_bytes);
}

void E57Pages::check(std::uint64_t page) const {
  if (page == checked_) return;
  const std::string_view whole = bytes_.substr(page * page_size_, page_size_);
  std::uint32_t stored = 0;  // the one big-endian number of the format
  for (const char byte : whole.substr(page_size_ - checksum_bytes))
    stored = stored << 8 | static_cast<unsigned char>(byte);
  if (crc32c(whole.substr(0, page_size_ - checksum_bytes)) != stored)
    throw byte_error(file_, page * page_size_,
                     "the checksum of this page of {} bytes is wrong: the file is damaged", page_size_);
  checked_ = page;
}

std::string E57Pages::read(std::uint64_t logical, std::uint64_t count) const {
  if (logical > size() || count > size() - logical)
    throw byte_error(file_, physical(std::min(logical, size())),
                     "{} bytes should follow, but the file ends before", count);
  const std::uint64_t payload = page_size_ - checksum_bytes;
  std::string bytes;
  bytes.reserve(count);
  while (count > 0) {
    const std::uint64_t page = logical / payload;
    check(page);
    const std::uint64_t within = logical % payload;
    const std::uint64_t part = std::min(count, payload - within);
    bytes.append(bytes_.substr(page * page_size_ + within, part));
    logical += part;
    count -= part;
  }
  return bytes;
}

std::string E57Pages::xml() const {
  return read(logical(xml_physical_), xml_size_);
}

E57Document::E57Document(const std::string& file, std::string_view bytes) : pages_(file, bytes) {
  const std::string text = pages_.xml();
  const pugi::xml_parse_result result = xml_.load_buffer(text.data(), text.size());
  if (!result || !root())
    throw input_error("{}: the XML section is damaged: {} at its byte {}", file,
                      result ? "no e57Root" : result.description(), result.offset);
}

std::optional<double> e57_number(const std::string& file, pugi::xml_node parent, const char* name) {
  const pugi::xml_node node = parent.child(name);
  if (!node) return std::nullopt;
  const std::string_view text = node.text().get();
  double value = 0;
  if (!text.empty()) {
    const auto number = parse_value(text);
    if (!number)
      throw input_error("{}: the XML section says {} = {}, which is no number", file, name, shown(text));
    value = *number;
  }
  if (std::string_view(node.attribute("type").value()) == "ScaledInteger")
    value = value * e57_attribute(file, node, "scale", 1) + e57_attribute(file, node, "offset", 0);
  return value;
}

double e57_attribute(const std::string& file, pugi::xml_node node, const char* name, double otherwise) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute) return otherwise;
  const auto number = parse_value(attribute.value());
  if (!number)
    throw input_error("{}: the XML section gives {} of {} as {}, which is no number", file, name, node.name(),
                      shown(attribute.value()));
  return *number;
}

std::int64_t e57_integer(const std::string& file, pugi::xml_node node, const char* name,
                         std::int64_t otherwise) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute) return otherwise;
  const auto number = parse_integer(attribute.value());
  if (!number)
    throw input_error("{}: the XML section gives {} of {} as {}, which is no whole number", file, name,
                      node.name(), shown(attribute.value()));
  return *number;
}

std::string e57_blob(const E57Pages& pages, pugi::xml_node blob) {
  const auto length = e57_integer(pages.file(), blob, "length", -1);
  const auto offset = e57_integer(pages.file(), blob, "fileOffset", -1);
  if (length < 0 || offset < 0) throw input_error("{}: a picture without place and length", pages.file());
  const std::uint64_t begin = pages.logical(static_cast<std::uint64_t>(offset));
  const std::string header = pages.read(begin, 16);  // section id 0, 7 reserved, length of the section
  if (header[0] != 0)
    throw byte_error(pages.file(), static_cast<std::uint64_t>(offset), "no picture begins here");
  return pages.read(begin + 16, static_cast<std::uint64_t>(length));
}

}  // namespace drape::io
