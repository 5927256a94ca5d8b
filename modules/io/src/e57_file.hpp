// The container of an E57 file (ASTM E2807): pages with checksums, and the XML section that describes the
// binary ones.
#pragma once

#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace drape::io {

/// The bytes of an E57 without its checksums. "Physical" places count the checksums, "logical" ones do not; a
/// page is checked whenever something of it is read.
class E57Pages {
 public:
  /// Error{input} if the file header makes no sense or does not fit the number of bytes.
  E57Pages(const std::string& file, std::string_view bytes);

  [[nodiscard]] std::uint64_t logical(std::uint64_t physical) const;
  [[nodiscard]] std::uint64_t physical(std::uint64_t logical) const;
  /// Logical bytes of the whole file.
  [[nodiscard]] std::uint64_t size() const;
  /// Error{input} if the bytes are not there or the checksum of a page is wrong.
  [[nodiscard]] std::string read(std::uint64_t logical, std::uint64_t size) const;
  [[nodiscard]] std::string xml() const;
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  void check(std::uint64_t page) const;

  const std::string& file_;
  std::string_view bytes_;
  std::uint64_t page_size_ = 0;
  std::uint64_t xml_physical_ = 0;
  std::uint64_t xml_size_ = 0;
  mutable std::uint64_t checked_ = UINT64_MAX;  // the page that was checked last
};

class E57Document {
 public:
  E57Document(const std::string& file, std::string_view bytes);

  [[nodiscard]] const E57Pages& pages() const { return pages_; }
  [[nodiscard]] pugi::xml_node root() const { return xml_.child("e57Root"); }

 private:
  E57Pages pages_;
  pugi::xml_document xml_;
};

/// The number in an element; nothing where the element is not there. An empty element is 0. Error{input} if
/// it is no number.
[[nodiscard]] std::optional<double> e57_number(const std::string& file, pugi::xml_node parent,
                                               const char* name);
/// The number of an attribute, or `otherwise`.
[[nodiscard]] double e57_attribute(const std::string& file, pugi::xml_node node, const char* name,
                                   double otherwise);
[[nodiscard]] std::int64_t e57_integer(const std::string& file, pugi::xml_node node, const char* name,
                                       std::int64_t otherwise);

/// The bytes of a Blob element.
[[nodiscard]] std::string e57_blob(const E57Pages& pages, pugi::xml_node blob);

}  // namespace drape::io
