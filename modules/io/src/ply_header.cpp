#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <utility>

#include "ply.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

// Far more than any file has; a header that goes on for ever is no header.
constexpr std::size_t most_header_lines = 100'000;
constexpr std::size_t most_properties = 10'000;

std::optional<PlyType> type_of(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> names{{
      {"char", PlyType::int8},
      {"int8", PlyType::int8},
      {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},
      {"short", PlyType::int16},
      {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},
      {"uint16", PlyType::uint16},
      {"int", PlyType::int32},
      {"int32", PlyType::int32},
      {"uint", PlyType::uint32},
      {"uint32", PlyType::uint32},
      {"float", PlyType::float32},
      {"float32", PlyType::float32},
      {"double", PlyType::float64},
      {"float64", PlyType::float64},
  }};
  for (const auto& [name, type] : names)
    if (name == word) return type;
  return std::nullopt;
}

/// Reads the lines of one header, keeping the place for messages.
class HeaderParser {
 public:
  HeaderParser(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes), rest_(bytes) {}

  PlyHeader parse() {
    if (!bytes_.starts_with("ply"))
      throw line_error(file_, 1, "is no PLY file: it does not start with \"ply\"");
    find_line_end();
    (void)next_line();
    while (next_line()) {
      Words words(line_);
      const std::string_view key = words.next();
      if (key == "end_header") return finish();
      if (key == "format")
        format(words);
      else if (key == "comment")
        header_.comments.emplace_back(words.rest());
      else if (key == "obj_info")
        header_.obj_infos.emplace_back(words.rest());
      else if (key == "element")
        element(words);
      else if (key == "property")
        property(words);
      else if (!key.empty())
        throw line_error(file_, header_.lines, "unknown PLY header line {}", shown(line_));
      if (header_.lines > most_header_lines) break;
    }
    throw line_error(file_, header_.lines,
                     "the PLY header ends without \"end_header\": the file is truncated");
  }

 private:
  /// The first line tells how all lines of the header end: after "end_header\r" a binary value may follow
  /// whose first byte is \n.
  void find_line_end() {
    const std::size_t end = bytes_.find_first_of("\r\n", 3);
    if (end == std::string_view::npos ||
        !std::all_of(bytes_.begin() + 3, bytes_.begin() + end, [](char c) { return c == ' ' || c == '\t'; }))
      throw line_error(file_, 1, "is no PLY file: the first line is not \"ply\"");
    line_end_ = bytes_[end] == '\n' ? "\n" : bytes_.substr(end).starts_with("\r\n") ? "\r\n" : "\r";
  }

  bool next_line() {
    // A line end of the other kind within the header is forgiven: find \n (or \r) and strip the \r before it.
    const char last = line_end_.back();
    const std::size_t end = rest_.find(last);
    ++header_.lines;
    if (end == std::string_view::npos) return false;
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (!line_.empty() && line_.back() == '\r') line_.remove_suffix(1);
    return true;
  }

  void format(Words& words) {
    const std::string_view name = words.next();
    if (name == "ascii")
      header_.format = PlyFormat::ascii;
    else if (name == "binary_little_endian")
      header_.format = PlyFormat::little_endian;
    else if (name == "binary_big_endian")
      header_.format = PlyFormat::big_endian;
    else
      throw line_error(file_, header_.lines, "unknown PLY format {}", shown(name));
    have_format_ = true;
  }

  void element(Words& words) {
    PlyElement element;
    element.name = words.next();
    element.header_line = header_.lines;
    const std::string_view count = words.next();
    const auto [end, problem] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (element.name.empty() || problem != std::errc{} || end != count.data() + count.size())
      throw line_error(file_, header_.lines, "an element needs a name and a count, not {}", shown(line_));
    for (const PlyElement& other : header_.elements)
      if (other.name == element.name)
        throw line_error(file_, header_.lines, "element {} comes twice", shown(element.name));
    header_.elements.push_back(std::move(element));
  }

  void property(Words& words) {
    if (header_.elements.empty())
      throw line_error(file_, header_.lines, "a property comes before any element");
    std::vector<PlyProperty>& properties = header_.elements.back().properties;
    PlyProperty property;
    std::string_view word = words.next();
    property.list = word == "list";
    if (property.list) {
      property.count_type = known_type(words.next());
      if (property.count_type == PlyType::float32 || property.count_type == PlyType::float64)
        throw line_error(file_, header_.lines, "the length of a list must be a whole number");
      word = words.next();
    }
    property.type = known_type(word);
    property.name = words.next();
    if (property.name.empty()) throw line_error(file_, header_.lines, "a property without a name");
    for (const PlyProperty& other : properties)
      if (other.name == property.name)
        throw line_error(file_, header_.lines, "property {} comes twice", shown(property.name));
    if (properties.size() >= most_properties)
      throw line_error(file_, header_.lines, "more than {} properties", most_properties);
    properties.push_back(std::move(property));
  }

  PlyType known_type(std::string_view word) const {
    if (const auto type = type_of(word)) return *type;
    throw line_error(file_, header_.lines, "unknown PLY type {}", shown(word));
  }

  PlyHeader finish() {
    if (!have_format_) throw line_error(file_, header_.lines, "the PLY header has no \"format\" line");
    header_.size = static_cast<std::size_t>(rest_.data() - bytes_.data());
    return std::move(header_);
  }

  const std::string& file_;
  std::string_view bytes_;
  std::string_view rest_;
  std::string_view line_;
  std::string_view line_end_ = "\n";
  bool have_format_ = false;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 0;
}

std::string PlyHeader::info(std::string_view key) const {
  for (const auto* list : {&obj_infos, &comments})
    for (const std::string& line : *list) {
      Words words(line);
      if (words.next() == key) return std::string(words.rest());
    }
  return {};
}

PlyHeader parse_ply_header(const std::string& file, std::string_view bytes) {
  return HeaderParser(file, bytes).parse();
}

}  // namespace drape::io
