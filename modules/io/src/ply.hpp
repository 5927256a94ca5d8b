// PLY (Turk 1994): the header, and the elements as columns of numbers. Scans, meshes and textured models are
// read and written through this.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drape/base/error.hpp"

namespace drape::io {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyFormat { ascii, little_endian, big_endian };

[[nodiscard]] std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool list = false;
  PlyType count_type = PlyType::uint8;  // of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::size_t header_line = 0;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;   // without the word "comment"
  std::vector<std::string> obj_infos;  // without the word "obj_info"
  std::size_t size = 0;                // bytes before the first element
  std::size_t lines = 0;

  /// What follows `key` in the first obj_info (or comment) that starts with it; empty if there is none.
  [[nodiscard]] std::string info(std::string_view key) const;
};

/// Error{input} `file:line:` for anything but a whole and sensible header. Counts are not compared with the
/// bytes yet.
[[nodiscard]] PlyHeader parse_ply_header(const std::string& file, std::string_view bytes);

/// The values of one property. Every PLY type fits into a double without loss.
struct PlyColumn {
  PlyProperty property;
  std::vector<double> values;     // one per row, or the entries of all lists one after the other
  std::vector<std::size_t> ends;  // lists: where in `values` each row's entries end

  [[nodiscard]] std::span<const double> row(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends[i - 1];
    return {values.data() + begin, ends[i] - begin};
  }
};

/// The columns that the caller asked for, of one element.
struct PlyTable {
  PlyElement element;
  std::vector<PlyColumn> columns;
  std::uint64_t begin = 0;               // where the first row lies: line (ASCII) or byte
  std::uint64_t row_bytes = 0;           // binary rows of one size; else 0, and:
  std::vector<std::uint64_t> positions;  // where each row lies

  [[nodiscard]] std::size_t rows() const { return static_cast<std::size_t>(element.count); }
  [[nodiscard]] std::uint64_t position(std::size_t row) const {
    return row_bytes != 0 ? begin + row * row_bytes : positions[row];
  }
  [[nodiscard]] const PlyColumn* column(std::string_view name) const;
  /// The first of these that is there.
  [[nodiscard]] const PlyColumn* column_of(std::initializer_list<std::string_view> names) const;
};

/// Names a column to read. Where `names_rows_of` is set, each value must be the number of a row of that
/// element, or `separator`.
struct PlyWanted {
  std::string element;
  std::string property;
  std::string names_rows_of = {};
  int separator = 0;  // a negative value that is allowed besides row numbers; 0: none
};

struct PlyFile {
  std::string file;
  PlyHeader header;
  std::vector<PlyTable> tables;  // of elements with a wanted column, in the file's order

  [[nodiscard]] const PlyTable* table(std::string_view element) const;
  [[nodiscard]] const PlyColumn* column(std::string_view element, std::string_view property) const;
  /// Error{input} that names the line or byte of a row.
  [[nodiscard]] Error row_error(const PlyTable& table, std::size_t row, const std::string& what) const;
};

/// Reads a file's wanted columns; everything else is stepped over and checked all the same. Error{input} with
/// line or byte: counts that the bytes do not hold (before anything of that size is allocated), a line with
/// too few or too many values, a value that its type cannot hold, a row number out of range, bytes after the
/// last element.
[[nodiscard]] PlyFile parse_ply(const std::string& file, std::string_view bytes,
                                const std::vector<PlyWanted>& wanted);
/// The same where the header is known: the first element of `header` begins at byte `header.size`.
[[nodiscard]] PlyFile parse_ply_body(const std::string& file, const PlyHeader& header, std::string_view bytes,
                                     const std::vector<PlyWanted>& wanted);
[[nodiscard]] PlyFile read_ply(const std::filesystem::path& file, const std::vector<PlyWanted>& wanted);

/// Builds a binary little-endian PLY: the header first, then the rows in its order.
class PlyBuilder {
 public:
  PlyBuilder();
  void comment(std::string_view text);
  void obj_info(std::string_view text);
  void element(std::string_view name, std::size_t count);
  void property(PlyType type, std::string_view name);
  void list_property(PlyType count_type, PlyType type, std::string_view name);
  /// After the last property; `body_size` is what to reserve.
  void end_header(std::size_t body_size);

  void put_double(double value);
  void put_float(float value);
  void put_int(std::int32_t value);
  void put_byte(std::uint8_t value);

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

}  // namespace drape::io
