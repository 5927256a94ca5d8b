// Points as text: no standard exists, so separator, header and columns are guessed, and the guess is told.
#include <algorithm>
#include <array>
#include <cmath>

#include "drape/base/log.hpp"
#include "drape/base/numbers.hpp"
#include "scan_builder.hpp"
#include "scan_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

constexpr std::size_t most_header_lines = 20;
constexpr std::size_t sample_size = 200;  // lines that the guess is made of

enum class Role { other, x, y, z, nx, ny, nz, red, green, blue, intensity, confidence };

struct Layout {
  char separator = ' ';  // ' ' for any blanks
  bool decimal_comma = false;
  std::size_t header_lines = 0;
  std::vector<Role> roles;  // per column
  bool named = false;       // by a header line, not by the values
};

/// The columns of a line. Commas and semicolons separate one by one, so that an empty column stays one.
std::vector<std::string_view> split(std::string_view line, char separator) {
  std::vector<std::string_view> words;
  if (separator == ' ') {
    Words rest(line);
    for (std::string_view word = rest.next(); !word.empty(); word = rest.next()) words.push_back(word);
    return words;
  }
  while (true) {
    const std::size_t end = line.find(separator);
    std::string_view word = line.substr(0, end);
    while (!word.empty() && (word.front() == ' ' || word.front() == '\t')) word.remove_prefix(1);
    while (!word.empty() && (word.back() == ' ' || word.back() == '\t')) word.remove_suffix(1);
    words.push_back(word);
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
  }
  if (words.back().empty()) words.pop_back();  // a separator at the end of the line
  return words;
}

std::optional<double> value_of(std::string_view word, bool decimal_comma) {
  if (!decimal_comma) return parse_value(word);
  std::string with_point(word);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return parse_value(with_point);
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with("//");
}

/// Whether the first three columns are numbers.
bool is_point(std::string_view line, const Layout& layout) {
  const auto words = split(line, layout.separator);
  return words.size() >= 3 && std::all_of(words.begin(), words.begin() + 3, [&](std::string_view word) {
           return value_of(word, layout.decimal_comma).has_value();
         });
}

/// The first way of splitting by which the line is a point.
std::optional<Layout> layout_of(std::string_view line) {
  for (const auto& [separator, decimal_comma] :
       {std::pair{';', false}, {';', true}, {',', false}, {' ', false}, {' ', true}}) {
    Layout layout;
    layout.separator = separator;
    layout.decimal_comma = decimal_comma;
    if (is_point(line, layout)) return layout;
  }
  return std::nullopt;
}

Role role_named(std::string_view word) {
  std::string name;
  for (const char c : word) {
    if (c == '[' || c == '(') break;  // a unit
    if (c >= 'A' && c <= 'Z')
      name += static_cast<char>(c - 'A' + 'a');
    else if (c >= 'a' && c <= 'z')
      name += c;
  }
  static constexpr std::array<std::pair<std::string_view, Role>, 22> names{{
      {"x", Role::x},
      {"y", Role::y},
      {"z", Role::z},
      {"nx", Role::nx},
      {"ny", Role::ny},
      {"nz", Role::nz},
      {"normalx", Role::nx},
      {"normaly", Role::ny},
      {"normalz", Role::nz},
      {"r", Role::red},
      {"g", Role::green},
      {"b", Role::blue},
      {"red", Role::red},
      {"green", Role::green},
      {"blue", Role::blue},
      {"i", Role::intensity},
      {"intensity", Role::intensity},
      {"scalarintensity", Role::intensity},
      {"reflectance", Role::intensity},
      {"amplitude", Role::intensity},
      {"confidence", Role::confidence},
      {"easting", Role::x},
  }};
  for (const auto& [known, role] : names)
    if (known == name) return role;
  if (name == "northing") return Role::y;
  if (name == "height" || name == "elevation") return Role::z;
  return Role::other;
}

/// The rows of the sample as numbers (0 where a column is none), to guess columns by.
using Rows = std::vector<std::vector<double>>;

bool are_colors(const Rows& sample, std::size_t column) {
  bool beyond_one = false;
  for (const auto& row : sample)
    for (std::size_t k = column; k < column + 3; ++k) {
      if (!(row[k] >= 0 && row[k] <= 255 && row[k] == std::floor(row[k]))) return false;
      beyond_one = beyond_one || row[k] > 1;
    }
  return beyond_one;
}

bool are_normals(const Rows& sample, std::size_t column) {
  return std::all_of(sample.begin(), sample.end(), [&](const std::vector<double>& row) {
    const double length = Eigen::Vector3d(row[column], row[column + 1], row[column + 2]).norm();
    return length == 0 || std::abs(length - 1) < 0.02;
  });
}

std::vector<Role> roles_by_value(const Rows& sample) {
  const std::size_t columns = sample.front().size();
  std::vector<Role> roles(columns, Role::other);
  roles[0] = Role::x;
  roles[1] = Role::y;
  roles[2] = Role::z;
  bool colors = false, normals = false, intensity = false;
  const auto set = [&](std::size_t at, std::array<Role, 3> three) {
    std::copy(three.begin(), three.end(), roles.begin() + static_cast<std::ptrdiff_t>(at));
  };
  for (std::size_t at = 3; at < columns;) {
    const bool three = at + 3 <= columns;
    // An intensity before colours (as in PTS) may itself look like a colour.
    const bool intensity_first =
        !intensity && (columns - at) % 3 == 1 && at + 4 <= columns && are_colors(sample, at + 1);
    if (three && !colors && !intensity_first && are_colors(sample, at)) {
      set(at, {Role::red, Role::green, Role::blue});
      colors = true;
      at += 3;
    } else if (three && !normals && !intensity_first && are_normals(sample, at)) {
      set(at, {Role::nx, Role::ny, Role::nz});
      normals = true;
      at += 3;
    } else {
      if (!intensity) roles[at] = Role::intensity;
      intensity = true;
      ++at;
    }
  }
  return roles;
}

/// Where the values of a row go.
class RowPlan {
 public:
  explicit RowPlan(const std::vector<Role>& roles) : roles_(roles) {
    const auto all = [&](std::initializer_list<Role> wanted) {
      return std::all_of(wanted.begin(), wanted.end(), [&](Role role) {
        return std::find(roles.begin(), roles.end(), role) != roles.end();
      });
    };
    fields.normals = all({Role::nx, Role::ny, Role::nz});
    fields.colors = all({Role::red, Role::green, Role::blue});
    fields.intensities = all({Role::intensity});
    fields.confidences = all({Role::confidence});
  }

  [[nodiscard]] double* target(Sample& sample, std::size_t column) const {
    const auto offset = [&](Role first) {
      return static_cast<Eigen::Index>(roles_[column]) - static_cast<Eigen::Index>(first);
    };
    switch (roles_[column]) {
      case Role::x:
      case Role::y:
      case Role::z:
        return &sample.position[offset(Role::x)];
      case Role::nx:
      case Role::ny:
      case Role::nz:
        return &sample.normal[offset(Role::nx)];
      case Role::red:
      case Role::green:
      case Role::blue:
        return &sample.color[offset(Role::red)];
      case Role::intensity:
        return &sample.intensity;
      default:
        return &sample.confidence;
    }
  }

  SampleFields fields;

 private:
  const std::vector<Role>& roles_;
};

std::string description(const Layout& layout) {
  static constexpr std::array<std::string_view, 12> names{
      "-", "x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "intensity", "confidence"};
  std::string text =
      layout.separator == ' ' ? "separated by blanks" : fmt::format("separated by \"{}\"", layout.separator);
  if (layout.decimal_comma) text += ", decimal comma";
  if (layout.header_lines > 0) text += fmt::format(", {} header lines", layout.header_lines);
  text += layout.named ? ", columns by their names:" : ", columns guessed:";
  for (const Role role : layout.roles) text += fmt::format(" {}", names[static_cast<std::size_t>(role)]);
  return text;
}

class XyzReader {
 public:
  explicit XyzReader(const ScanSource& source)
      : file_(source.file),
        bytes_(source.bytes.starts_with("\xEF\xBB\xBF") ? source.bytes.substr(3) : source.bytes),
        options_(source.options) {}

  std::vector<RangeScan> read() {
    guess();
    log::info("{}: read as text, {}", file_, description(layout_));
    read_rows();
    return std::move(scans_);
  }

 private:
  /// Looks at the beginning of the file.
  void guess() {
    TextLines lines(bytes_);
    std::string_view names;
    std::optional<Layout> layout;
    while (!layout && lines.next_filled()) {
      if (lines.number() > most_header_lines + 1) break;
      layout = layout_of(lines.line());
      if (layout) break;
      read_count(lines.line());
      names = lines.line();
    }
    if (!layout)
      throw line_error(file_, lines.number(), "no line with three numbers: {}", shown(lines.line()));
    layout_ = *layout;
    layout_.header_lines = lines.number() - 1;
    const std::size_t columns = split(lines.line(), layout_.separator).size();
    if (!options_.columns.empty())
      state_columns(lines.number(), columns);
    else if (!name_columns(names, columns))
      layout_.roles = roles_by_value(sample(lines, columns));
  }

  /// A line with one whole number before the points says how many there are.
  void read_count(std::string_view line) {
    Words words(line);
    const auto count = parse_integer(words.next());
    if (count && *count > 0 && words.rest().empty()) claimed_ = *count;
  }

  bool name_columns(std::string_view names, std::size_t columns) {
    if (is_comment(names)) names.remove_prefix(names.starts_with('#') ? 1 : 2);
    for (const char separator : {layout_.separator, ',', ';', ' '}) {
      const auto words = split(names, separator);
      if (words.size() != columns) continue;
      std::vector<Role> roles;
      for (const std::string_view word : words) {
        const Role role = role_named(word);
        const bool again = std::find(roles.begin(), roles.end(), role) != roles.end();
        roles.push_back(again ? Role::other : role);
      }
      const auto has = [&](Role role) { return std::find(roles.begin(), roles.end(), role) != roles.end(); };
      if (!has(Role::x) || !has(Role::y) || !has(Role::z)) continue;
      layout_.roles = std::move(roles);
      layout_.named = true;
      return true;
    }
    return false;
  }

  /// By `input.columns`.
  void state_columns(std::size_t line, std::size_t columns) {
    if (options_.columns.size() != columns)
      throw line_error(file_, line, "has {} columns, but input.columns names {}", columns,
                       options_.columns.size());
    for (const std::string& name : options_.columns) layout_.roles.push_back(role_named(name));
    layout_.named = true;
    for (const Role role : {Role::x, Role::y, Role::z})
      if (std::count(layout_.roles.begin(), layout_.roles.end(), role) != 1)
        throw line_error(file_, line, "input.columns must name x, y and z once each");
  }

  Rows sample(TextLines lines, std::size_t columns) const {
    Rows sample;
    do {
      const auto words = split(lines.line(), layout_.separator);
      if (words.size() != columns) continue;  // told when the rows are read
      std::vector<double> row;
      for (const std::string_view word : words)
        row.push_back(value_of(word, layout_.decimal_comma).value_or(0));
      sample.push_back(std::move(row));
    } while (sample.size() < sample_size && lines.next_filled());
    return sample;
  }

  void read_rows() {
    TextLines lines(bytes_);
    RowPlan plan(layout_.roles);
    ScanBuilder builder(file_, plan.fields, options_.most_points);
    while (lines.next_filled()) {
      if (lines.number() <= layout_.header_lines || is_comment(lines.line())) continue;
      auto words = split(lines.line(), layout_.separator);
      if (claimed_ > 0 && words.size() == 1 && layout_.roles.size() > 1) {  // the count of a further scan
        finish(builder);
        builder = ScanBuilder(file_, plan.fields, options_.most_points);
        read_count(lines.line());
        continue;
      }
      // An empty last column looks like a separator at the end of the line.
      if (layout_.separator != ' ' && words.size() + 1 == layout_.roles.size() &&
          lines.line().ends_with(layout_.separator))
        words.emplace_back();
      if (words.size() != layout_.roles.size())
        throw line_error(file_, lines.number(), "has {} columns, but the first point has {}", words.size(),
                         layout_.roles.size());
      Sample sample;
      for (std::size_t k = 0; k < words.size(); ++k) {
        if (layout_.roles[k] == Role::other) continue;
        const auto value = value_of(words[k], layout_.decimal_comma);
        if (!value) throw line_error(file_, lines.number(), "{} is no number", shown(words[k]));
        *plan.target(sample, k) = *value;
      }
      ++rows_;
      builder.add(sample);
    }
    if (!lines.ended()) log::warn("{}: the last line has no line end: the file may be truncated", file_);
    finish(builder);
  }

  void finish(ScanBuilder& builder) {
    if (claimed_ > 0 && claimed_ != rows_)
      log::warn("{}: claims {} points at its top, but holds {}", file_, claimed_, rows_);
    rows_ = 0;
    scans_.push_back(builder.finish());
  }

  const std::string& file_;
  std::string_view bytes_;
  const ScanReadOptions& options_;
  Layout layout_;
  std::int64_t claimed_ = 0;
  std::int64_t rows_ = 0;
  std::vector<RangeScan> scans_;
};

}  // namespace

std::vector<RangeScan> read_xyz_scan(const ScanSource& source) {
  return XyzReader(source).read();
}

}  // namespace drape::io
