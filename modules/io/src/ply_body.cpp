#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "drape/base/files.hpp"
#include "drape/base/log.hpp"
#include "ply.hpp"
#include "text_lines.hpp"

static_assert(std::endian::native == std::endian::little, "binary PLY is read and written by copying bytes");

namespace drape::io {
namespace {

/// What to do with one property of a row.
struct Step {
  const PlyProperty* property = nullptr;
  PlyColumn* column = nullptr;  // null: step over
  std::uint64_t row_limit = 0;  // values must be below; 0: any value
  int separator = 0;
};

struct Limits {
  double least, most;
};

Limits limits_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
      return {-128, 127};
    case PlyType::uint8:
      return {0, 255};
    case PlyType::int16:
      return {-32768, 32767};
    case PlyType::uint16:
      return {0, 65535};
    case PlyType::int32:
      return {-2147483648.0, 2147483647.0};
    case PlyType::uint32:
      return {0, 4294967295.0};
    default:
      return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
}

bool is_float(PlyType type) {
  return type == PlyType::float32 || type == PlyType::float64;
}

template <class Number>
double load_as(const char* at, bool swap) {
  std::array<char, sizeof(Number)> bytes;
  std::memcpy(bytes.data(), at, bytes.size());
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<Number>(bytes));
}

double load(PlyType type, const char* at, bool swap) {
  switch (type) {
    case PlyType::int8:
      return load_as<std::int8_t>(at, swap);
    case PlyType::uint8:
      return load_as<std::uint8_t>(at, swap);
    case PlyType::int16:
      return load_as<std::int16_t>(at, swap);
    case PlyType::uint16:
      return load_as<std::uint16_t>(at, swap);
    case PlyType::int32:
      return load_as<std::int32_t>(at, swap);
    case PlyType::uint32:
      return load_as<std::uint32_t>(at, swap);
    case PlyType::float32:
      return load_as<float>(at, swap);
    case PlyType::float64:
      return load_as<double>(at, swap);
  }
  return 0;
}

/// Holds what reading text and reading bytes have in common: which columns to fill, and room for them.
class BodyReader {
 public:
  BodyReader(const std::string& file, const PlyHeader& header, const std::vector<PlyWanted>& wanted)
      : file_(file), header_(header), wanted_(wanted) {}

 protected:
  /// A table with the wanted columns of an element, without rows.
  [[nodiscard]] PlyTable table_for(const PlyElement& element) const {
    PlyTable table;
    table.element = element;
    for (const PlyProperty& property : element.properties)
      if (find_wanted(element, property) != nullptr) table.columns.push_back({property, {}, {}});
    return table;
  }

  [[nodiscard]] std::vector<Step> steps_for(PlyTable& table) const {
    std::vector<Step> steps;
    for (const PlyProperty& property : table.element.properties) {
      Step step{&property, nullptr, 0, 0};
      if (const PlyWanted* wanted = find_wanted(table.element, property)) {
        for (PlyColumn& column : table.columns)
          if (column.property.name == property.name) step.column = &column;
        step.separator = wanted->separator;
        if (!wanted->names_rows_of.empty())
          step.row_limit = std::max<std::uint64_t>(1, rows_of(wanted->names_rows_of));
      }
      steps.push_back(step);
    }
    return steps;
  }

  /// To be called once the count is known to fit into the bytes that are there.
  static void reserve(PlyTable& table) {
    const auto count = static_cast<std::size_t>(table.element.count);
    for (PlyColumn& column : table.columns)
      (column.property.list ? column.ends.reserve(count) : column.values.reserve(count));
    if (table.row_bytes == 0 && !table.columns.empty()) table.positions.reserve(count);
  }

  /// Empty if `value` may stand in the column; else what is wrong.
  [[nodiscard]] std::string problem(const Step& step, double value) const {
    if (step.row_limit == 0 ||
        (value >= 0 && value < static_cast<double>(step.row_limit) && value == std::floor(value)))
      return {};
    if (step.separator != 0 && value == step.separator) return {};
    return fmt::format("{} {} is out of range: there are {} of them", step.property->name, value,
                       rows_named(step));
  }

  [[nodiscard]] Error short_of_rows(const PlyElement& element, std::uint64_t row) const {
    return input_error(
        "{}: the file ends after {} of the {} rows of element {} that its header declares (line {})", file_,
        row, element.count, shown(element.name), element.header_line);
  }

  const std::string& file_;
  const PlyHeader& header_;

 private:
  [[nodiscard]] const PlyWanted* find_wanted(const PlyElement& element, const PlyProperty& property) const {
    for (const PlyWanted& wanted : wanted_)
      if (wanted.element == element.name && wanted.property == property.name) return &wanted;
    return nullptr;
  }

  [[nodiscard]] std::uint64_t rows_of(const std::string& element) const {
    for (const PlyElement& other : header_.elements)
      if (other.name == element) return other.count;
    return 0;
  }

  [[nodiscard]] std::uint64_t rows_named(const Step& step) const {
    for (const PlyWanted& wanted : wanted_)
      if (wanted.property == step.property->name && !wanted.names_rows_of.empty())
        return rows_of(wanted.names_rows_of);
    return step.row_limit;
  }

  const std::vector<PlyWanted>& wanted_;
};

class TextBody : BodyReader {
 public:
  TextBody(const std::string& file, const PlyHeader& header, const std::vector<PlyWanted>& wanted,
           std::string_view body)
      : BodyReader(file, header, wanted), lines_(body, header.lines + 1) {}

  std::vector<PlyTable> read() {
    std::vector<PlyTable> tables;
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      PlyTable table = table_for(element);
      read_rows(table);
      if (!table.columns.empty()) tables.push_back(std::move(table));
    }
    if (!lines_.ended()) log::warn("{}: the last line has no line end: the file may be truncated", file_);
    while (lines_.next_filled())
      if (lines_.line().find_first_not_of(std::string_view(" \t\0\x1a", 4)) != std::string_view::npos)
        throw line_error(file_, lines_.number(), "data go on after the last row that the header declares");
    return tables;
  }

 private:
  void read_rows(PlyTable& table) {
    const PlyElement& element = table.element;
    // Each value takes a digit and a separator; the last may do without one.
    if (element.count > (lines_.rest().size() + 1) / (2 * element.properties.size()))
      throw line_error(file_, element.header_line, "element {} claims {} rows, but only {} bytes follow",
                       shown(element.name), element.count, lines_.rest().size());
    reserve(table);
    const std::vector<Step> steps = steps_for(table);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (!lines_.next_filled()) throw short_of_rows(element, row);
      if (!table.columns.empty()) table.positions.push_back(lines_.number());
      Words words(lines_.line());
      for (const Step& step : steps) step.property->list ? read_list(step, words) : read_scalar(step, words);
      if (!words.rest().empty())
        throw line_error(file_, lines_.number(), "more values than element {} has properties",
                         shown(element.name));
    }
  }

  void read_scalar(const Step& step, Words& words) {
    const std::string_view word = next_word(step, words);
    if (step.column != nullptr) step.column->values.push_back(value_of(step, word));
  }

  void read_list(const Step& step, Words& words) {
    const std::string_view word = next_word(step, words);
    const std::optional<double> count = parse_value(word);
    const auto most = static_cast<double>((lines_.line().size() + 1) / 2);
    if (!count || !(*count >= 0 && *count == std::floor(*count)))
      throw line_error(file_, lines_.number(), "{} is no length for the list {}", shown(word),
                       shown(step.property->name));
    if (*count > most)
      throw line_error(file_, lines_.number(), "the list {} claims {} entries, which the line does not hold",
                       shown(step.property->name), *count);
    for (double i = 0; i < *count; ++i) read_scalar(step, words);
    if (step.column != nullptr) step.column->ends.push_back(step.column->values.size());
  }

  std::string_view next_word(const Step& step, Words& words) const {
    const std::string_view word = words.next();
    if (word.empty())
      throw line_error(file_, lines_.number(), "too few values: {} is missing", shown(step.property->name));
    return word;
  }

  double value_of(const Step& step, std::string_view word) const {
    const std::optional<double> value = parse_value(word);
    if (!value) throw line_error(file_, lines_.number(), "{} is no number", shown(word));
    const PlyType type = step.property->type;
    if (!is_float(type)) {
      const Limits limits = limits_of(type);
      if (!(*value >= limits.least && *value <= limits.most && *value == std::floor(*value)))
        throw line_error(file_, lines_.number(), "{} does not fit the type of property {}", shown(word),
                         shown(step.property->name));
    }
    if (const std::string wrong = problem(step, *value); !wrong.empty())
      throw line_error(file_, lines_.number(), "{}", wrong);
    return *value;
  }

  TextLines lines_;
};

class BinaryBody : BodyReader {
 public:
  BinaryBody(const std::string& file, const PlyHeader& header, const std::vector<PlyWanted>& wanted,
             std::string_view bytes)
      : BodyReader(file, header, wanted),
        bytes_(bytes),
        at_(header.size),
        swap_(header.format == PlyFormat::big_endian) {}

  std::vector<PlyTable> read() {
    std::vector<PlyTable> tables;
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;
      PlyTable table = table_for(element);
      read_rows(table);
      if (!table.columns.empty()) tables.push_back(std::move(table));
    }
    if (bytes_.find_first_not_of(std::string_view(" \t\r\n\0\x1a", 6), at_) != std::string_view::npos)
      throw byte_error(file_, at_, "{} bytes follow the last row that the header declares",
                       bytes_.size() - at_);
    return tables;
  }

 private:
  void read_rows(PlyTable& table) {
    const PlyElement& element = table.element;
    std::uint64_t least = 0;  // bytes of a row
    bool fixed = true;
    for (const PlyProperty& property : element.properties) {
      least += size_of(property.list ? property.count_type : property.type);
      fixed = fixed && !property.list;
    }
    if (element.count > left() / least)
      throw byte_error(file_, at_, "element {} claims {} rows of at least {} bytes, but only {} bytes follow",
                       shown(element.name), element.count, least, left());
    table.begin = at_;
    table.row_bytes = fixed ? least : 0;
    if (fixed && table.columns.empty()) {
      at_ += static_cast<std::size_t>(element.count * least);
      return;
    }
    reserve(table);
    const std::vector<Step> steps = steps_for(table);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (!fixed && !table.columns.empty()) table.positions.push_back(at_);
      for (const Step& step : steps) step.property->list ? read_list(step) : read_scalar(step);
    }
  }

  void read_list(const Step& step) {
    const PlyProperty& property = *step.property;
    const std::size_t begin = at_;
    const double length = take(property.count_type);
    if (length < 0)
      throw byte_error(file_, begin, "{} is no length for the list {}", length, shown(property.name));
    const auto count = static_cast<std::uint64_t>(length);
    if (count > left() / size_of(property.type))
      throw byte_error(file_, begin, "the list {} claims {} entries, but only {} bytes follow",
                       shown(property.name), count, left());
    if (step.column == nullptr) {
      at_ += static_cast<std::size_t>(count * size_of(property.type));
      return;
    }
    for (std::uint64_t i = 0; i < count; ++i) read_scalar(step);
    step.column->ends.push_back(step.column->values.size());
  }

  void read_scalar(const Step& step) {
    const std::size_t begin = at_;
    if (step.column == nullptr) {
      if (size_of(step.property->type) > left()) throw short_at(begin);
      at_ += size_of(step.property->type);
      return;
    }
    const double value = take(step.property->type);
    if (step.row_limit != 0)
      if (const std::string wrong = problem(step, value); !wrong.empty())
        throw byte_error(file_, begin, "{}", wrong);
    step.column->values.push_back(value);
  }

  double take(PlyType type) {
    const std::size_t size = size_of(type);
    if (size > left()) throw short_at(at_);
    const double value = load(type, bytes_.data() + at_, swap_);
    at_ += size;
    return value;
  }

  [[nodiscard]] Error short_at(std::size_t byte) const {
    return byte_error(file_, byte, "the file ends within the rows that its header declares");
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

  std::string_view bytes_;
  std::size_t at_;
  bool swap_;
};

}  // namespace

const PlyColumn* PlyTable::column(std::string_view name) const {
  for (const PlyColumn& candidate : columns)
    if (candidate.property.name == name) return &candidate;
  return nullptr;
}

const PlyColumn* PlyTable::column_of(std::initializer_list<std::string_view> names) const {
  for (const std::string_view name : names)
    if (const PlyColumn* found = column(name)) return found;
  return nullptr;
}

const PlyTable* PlyFile::table(std::string_view element) const {
  for (const PlyTable& candidate : tables)
    if (candidate.element.name == element) return &candidate;
  return nullptr;
}

const PlyColumn* PlyFile::column(std::string_view element, std::string_view property) const {
  const PlyTable* found = table(element);
  return found == nullptr ? nullptr : found->column(property);
}

Error PlyFile::row_error(const PlyTable& table, std::size_t row, const std::string& what) const {
  return header.format == PlyFormat::ascii ? line_error(file, table.position(row), "{}", what)
                                           : byte_error(file, table.position(row), "{}", what);
}

PlyFile parse_ply_body(const std::string& file, const PlyHeader& header, std::string_view bytes,
                       const std::vector<PlyWanted>& wanted) {
  PlyFile ply{file, header, {}};
  ply.tables = header.format == PlyFormat::ascii
                   ? TextBody(file, ply.header, wanted, bytes.substr(header.size)).read()
                   : BinaryBody(file, ply.header, wanted, bytes).read();
  return ply;
}

PlyFile parse_ply(const std::string& file, std::string_view bytes, const std::vector<PlyWanted>& wanted) {
  return parse_ply_body(file, parse_ply_header(file, bytes), bytes, wanted);
}

PlyFile read_ply(const std::filesystem::path& file, const std::vector<PlyWanted>& wanted) {
  return parse_ply(file.string(), read_file(file), wanted);
}

}  // namespace drape::io
