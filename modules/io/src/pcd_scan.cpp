// PCD, the Point Cloud Library's format, versions 0.5 to 0.7 (PCL documentation, "The PCD file format").
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "attribute_scale.hpp"
#include "drape/base/log.hpp"
#include "drape/base/numbers.hpp"
#include "lzf.hpp"
#include "scan_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

struct Field {
  std::string name;
  std::uint64_t size = 0;    // bytes of one value: 1, 2, 4, 8
  char type = 'F';           // I, U, F
  std::uint64_t count = 1;   // values of a point
  std::uint64_t offset = 0;  // bytes before it within a point
};

struct PcdHeader {
  std::vector<Field> fields;
  std::uint64_t width = 0, height = 1, points = 0;
  std::uint64_t point_size = 0;
  std::optional<Eigen::Vector3d> origin;
  std::string data;  // ascii, binary, binary_compressed
  std::size_t size = 0;
  std::size_t lines = 0;
};

/// The values of one field, first value of each point only.
struct Column {
  const Field* field;
  std::vector<double> values;
};

constexpr std::array<std::string_view, 9> wanted{"x",        "y",   "z",    "normal_x", "normal_y",
                                                 "normal_z", "rgb", "rgba", "intensity"};

bool is_wanted(const Field& field) {
  return std::find(wanted.begin(), wanted.end(), field.name) != wanted.end();
}
bool is_packed_color(const Field& field) {
  return field.name == "rgb" || field.name == "rgba";
}

class PcdReader {
 public:
  PcdReader(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  RangeScan read() {
    read_header();
    for (const Field& field : header_.fields)
      if (is_wanted(field)) columns_.push_back({&field, {}});
    for (const std::string_view name : {"x", "y", "z"})
      if (column(name) == nullptr) throw input_error("{}: the points have no field \"{}\"", file_, name);
    if (header_.data == "ascii")
      read_ascii();
    else if (header_.data == "binary")
      read_binary();
    else
      read_compressed();
    return scan();
  }

 private:
  // --- header

  void read_header() {
    TextLines lines(bytes_);
    bool have_points = false;
    while (lines.next_filled()) {
      header_.lines = lines.number();
      Words words(lines.line());
      const std::string_view key = words.next();
      if (key.starts_with('#') || key == "VERSION") continue;
      if (key == "FIELDS" || key == "COLUMNS")
        read_fields(words);
      else if (key == "SIZE")
        each_field(words, [&](Field& f, std::string_view w) { f.size = whole(w, 8); });
      else if (key == "TYPE")
        each_field(words, [&](Field& f, std::string_view w) { f.type = w.front(); });
      else if (key == "COUNT")
        each_field(words, [&](Field& f, std::string_view w) { f.count = whole(w, 1U << 20); });
      else if (key == "WIDTH")
        header_.width = whole(words.next(), 1ULL << 31);
      else if (key == "HEIGHT")
        header_.height = whole(words.next(), 1ULL << 31);
      else if (key == "VIEWPOINT")
        read_viewpoint(words);
      else if (key == "POINTS") {
        header_.points = whole(words.next(), 1ULL << 62);
        have_points = true;
      } else if (key == "DATA") {
        header_.data = words.next();
        header_.size = bytes_.size() - lines.rest().size();
        return check_header(have_points);
      } else {
        throw line_error(file_, header_.lines, "unknown PCD header line {}", shown(lines.line()));
      }
    }
    throw line_error(file_, header_.lines,
                     "the PCD header ends without \"DATA\": the file is truncated or no PCD");
  }

  void read_fields(Words& words) {
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      header_.fields.push_back({std::string(word), 4, 'F', 1, 0});
      const auto same = [&](const Field& f) { return f.name == word && f.name != "_"; };
      if (std::count_if(header_.fields.begin(), header_.fields.end(), same) > 1)
        throw line_error(file_, header_.lines, "field {} comes twice", shown(word));
    }
  }

  template <class Set>
  void each_field(Words& words, Set set) {
    for (Field& field : header_.fields) {
      const std::string_view word = words.next();
      if (word.empty())
        throw line_error(file_, header_.lines, "there are {} fields, but fewer values",
                         header_.fields.size());
      set(field, word);
    }
    if (!words.rest().empty())
      throw line_error(file_, header_.lines, "there are {} fields, but more values", header_.fields.size());
  }

  void read_viewpoint(Words& words) {
    std::array<double, 7> numbers{};
    for (double& number : numbers) {
      const std::string_view word = words.next();
      const auto value = parse_value(word);
      if (!value || !std::isfinite(*value))
        throw line_error(file_, header_.lines, "VIEWPOINT needs seven numbers");
      number = *value;
    }
    header_.origin = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  }

  std::uint64_t whole(std::string_view word, std::uint64_t most) const {
    const auto value = parse_integer(word);
    if (!value || *value < 0 || static_cast<std::uint64_t>(*value) > most)
      throw line_error(file_, header_.lines, "{} is no whole number within 0 and {}", shown(word), most);
    return static_cast<std::uint64_t>(*value);
  }

  void check_header(bool have_points) {
    for (Field& field : header_.fields) {
      const bool known = field.type == 'F'
                             ? field.size == 4 || field.size == 8
                             : (field.type == 'I' || field.type == 'U') && std::has_single_bit(field.size);
      if (!known)
        throw input_error("{}: field {} has type {} of {} bytes, which PCD does not have", file_,
                          shown(field.name), field.type, field.size);
      if (is_packed_color(field) && field.size != 4)
        throw input_error("{}: field {} should have 4 bytes", file_, shown(field.name));
      if (is_wanted(field) && field.count != 1)
        throw input_error("{}: field {} should have one value a point", file_, shown(field.name));
      field.offset = header_.point_size;
      header_.point_size += field.size * field.count;
    }
    const std::uint64_t cells = header_.width * header_.height;
    if (!have_points) header_.points = cells;
    if (header_.points != cells)
      throw input_error("{}: POINTS is {}, but WIDTH x HEIGHT is {}", file_, header_.points, cells);
    if (header_.data != "ascii" && header_.data != "binary" && header_.data != "binary_compressed")
      throw line_error(file_, header_.lines, "unknown PCD data {}", shown(header_.data));
    if (header_.point_size == 0) throw input_error("{}: the points have no fields", file_);
  }

  // --- data

  void reserve() {
    for (Column& column : columns_) column.values.reserve(static_cast<std::size_t>(header_.points));
  }

  void read_ascii() {
    const std::string_view body = bytes_.substr(header_.size);
    if (header_.points > (body.size() + 1) / 2 / header_.fields.size())
      throw input_error("{}: the header claims {} points, but only {} bytes follow", file_, header_.points,
                        body.size());
    reserve();
    TextLines lines(body, header_.lines + 1);
    for (std::uint64_t point = 0; point < header_.points; ++point) {
      if (!lines.next_filled())
        throw input_error("{}: the file ends after {} of the {} points that its header declares", file_,
                          point, header_.points);
      Words words(lines.line());
      std::size_t column = 0;
      for (const Field& field : header_.fields) {
        const bool keep = column < columns_.size() && columns_[column].field == &field;
        for (std::uint64_t i = 0; i < field.count; ++i) {
          const std::string_view word = words.next();
          if (word.empty())
            throw line_error(file_, lines.number(), "too few values: {} is missing", shown(field.name));
          if (!keep) continue;
          const auto value = parse_value(word);
          if (!value) throw line_error(file_, lines.number(), "{} is no number", shown(word));
          columns_[column].values.push_back(is_packed_color(field) ? packed(field, *value) : *value);
        }
        if (keep) ++column;
      }
      if (!words.rest().empty())
        throw line_error(file_, lines.number(), "more values than the header has fields");
    }
    if (!lines.ended()) log::warn("{}: the last line has no line end: the file may be truncated", file_);
    if (lines.next_filled())
      throw line_error(file_, lines.number(), "data go on after the last point that the header declares");
  }

  /// A colour in text: the whole number itself, or the float that has its bits.
  static double packed(const Field& field, double value) {
    if (field.type != 'F') return value;
    return static_cast<double>(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
  }

  void read_binary() {
    const std::uint64_t left = bytes_.size() - header_.size;
    if (header_.points > left / header_.point_size)
      throw byte_error(file_, header_.size,
                       "the header claims {} points of {} bytes, but only {} bytes follow", header_.points,
                       header_.point_size, left);
    reserve();
    for (Column& column : columns_)
      take(column, bytes_.data() + header_.size + column.field->offset,
           static_cast<std::size_t>(header_.point_size));
    const std::uint64_t end = header_.size + header_.points * header_.point_size;
    check_end(static_cast<std::size_t>(end));
  }

  void read_compressed() {
    if (bytes_.size() - header_.size < 8)
      throw byte_error(file_, header_.size, "the sizes of the compressed data are missing");
    const std::uint64_t packed_size = load<std::uint32_t>(bytes_.data() + header_.size);
    const std::uint64_t size = load<std::uint32_t>(bytes_.data() + header_.size + 4);
    const std::size_t begin = header_.size + 8;
    if (packed_size > bytes_.size() - begin)
      throw byte_error(file_, header_.size, "{} compressed bytes are claimed, but only {} follow",
                       packed_size, bytes_.size() - begin);
    if (header_.points > size / header_.point_size || header_.points * header_.point_size != size ||
        size > most_lzf_bytes(packed_size))
      throw byte_error(file_, header_.size,
                       "the header claims {} points of {} bytes, but the compressed data {} bytes",
                       header_.points, header_.point_size, size);
    check_end(begin + static_cast<std::size_t>(packed_size));
    const auto data = lzf_decompressed(bytes_.substr(begin, packed_size), size);
    if (!data) throw byte_error(file_, begin, "the compressed data are damaged");
    reserve();
    // All values of a field lie together.
    for (Column& column : columns_)
      take(column, data->data() + header_.points * column.field->offset,
           static_cast<std::size_t>(column.field->size * column.field->count));
  }

  void check_end(std::size_t at) const {
    if (bytes_.find_first_not_of(std::string_view(" \t\r\n\0", 5), at) != std::string_view::npos)
      throw byte_error(file_, at, "{} bytes follow the last point that the header declares",
                       bytes_.size() - at);
  }

  void take(Column& column, const char* at, std::size_t stride) const {
    for (std::uint64_t i = 0; i < header_.points; ++i, at += stride)
      column.values.push_back(is_packed_color(*column.field) ? load<std::uint32_t>(at)
                                                             : value(*column.field, at));
  }

  template <class Number>
  static Number load(const char* at) {
    Number number;
    std::memcpy(&number, at, sizeof number);
    return number;
  }

  static double value(const Field& field, const char* at) {
    if (field.type == 'F') return field.size == 4 ? static_cast<double>(load<float>(at)) : load<double>(at);
    const bool is_signed = field.type == 'I';
    switch (field.size) {
      case 1:
        return is_signed ? load<std::int8_t>(at) : load<std::uint8_t>(at);
      case 2:
        return is_signed ? load<std::int16_t>(at) : load<std::uint16_t>(at);
      case 4:
        return is_signed ? load<std::int32_t>(at) : load<std::uint32_t>(at);
      default:
        return is_signed ? static_cast<double>(load<std::int64_t>(at))
                         : static_cast<double>(load<std::uint64_t>(at));
    }
  }

  // --- what it means

  const Column* column(std::string_view name) const {
    for (const Column& candidate : columns_)
      if (candidate.field->name == name) return &candidate;
    return nullptr;
  }

  RangeScan scan() const {
    RangeScan scan;
    const auto count = static_cast<std::size_t>(header_.points);
    const auto vector = [&](std::string_view x, std::string_view y, std::string_view z, std::size_t i) {
      return Eigen::Vector3d(column(x)->values[i], column(y)->values[i], column(z)->values[i]);
    };
    scan.cloud.positions.reserve(count);
    for (std::size_t i = 0; i < count; ++i) scan.cloud.positions.push_back(vector("x", "y", "z", i));
    if (column("normal_x") && column("normal_y") && column("normal_z")) {
      std::vector<Eigen::Vector3d> normals;
      normals.reserve(count);
      for (std::size_t i = 0; i < count; ++i)
        normals.push_back(vector("normal_x", "normal_y", "normal_z", i));
      scan.cloud.normals = unit_normals(normals);
    }
    if (const Column* color = column("rgb") ? column("rgb") : column("rgba"))
      for (const double value : color->values) {
        const auto bits =
            static_cast<std::uint32_t>(std::isfinite(value) ? std::clamp(value, 0.0, 4294967295.0) : 0);
        scan.cloud.colors.emplace_back(static_cast<float>(bits >> 16 & 255) / 255.0F,
                                       static_cast<float>(bits >> 8 & 255) / 255.0F,
                                       static_cast<float>(bits & 255) / 255.0F);
      }
    if (const Column* intensity = column("intensity"))
      scan.cloud.intensities = scaled_intensities({intensity->values.begin(), intensity->values.end()});
    if (header_.origin) scan.view = {ScanView::Kind::origin, *header_.origin};
    add_grid(scan);
    return scan;
  }

  /// Of an organised cloud. A cell without a point holds nan; some sensors write their own place instead.
  void add_grid(RangeScan& scan) const {
    if (header_.width < 2 || header_.height < 2) return;
    if (header_.points > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
      throw input_error("{}: has too many points for a range grid", file_);
    RangeGrid grid{static_cast<int>(header_.height), static_cast<int>(header_.width), {}};
    grid.cells.reserve(scan.cloud.size());
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) grid.cells.push_back(static_cast<std::int32_t>(i));
    scan.grid = std::move(grid);
    if (!header_.origin) return;
    for (Eigen::Vector3d& point : scan.cloud.positions)
      if (point == *header_.origin) point.setConstant(std::numeric_limits<double>::quiet_NaN());
  }

  const std::string& file_;
  std::string_view bytes_;
  PcdHeader header_;
  std::vector<Column> columns_;
};

}  // namespace

std::vector<RangeScan> read_pcd_scan(const ScanSource& source) {
  return {PcdReader(source.file, source.bytes).read()};
}

}  // namespace drape::io
