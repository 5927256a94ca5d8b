#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/io/scan_files.hpp"
#include "ply_vertices.hpp"
#include "scan_builder.hpp"
#include "scan_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

// --- obj_info lines of drape's own files

/// A base name on one line of a header: control characters, blanks at the ends and % as %XX.
std::string escaped(const std::string& name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool end = i == 0 || i + 1 == name.size();
    if (c < ' ' || c == 127 || c == '%' || (c == ' ' && end))
      text += fmt::format("%{:02X}", c);
    else
      text += name[i];
  }
  return text;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string unescaped(const std::string& text) {
  std::string name;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool coded =
        text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0;
    name += coded ? static_cast<char>(16 * hex_digit(text[i + 1]) + hex_digit(text[i + 2])) : text[i];
    if (coded) i += 2;
  }
  return name;
}

/// `count` numbers of an obj_info line; empty if the line is not there. Error{input} if they are not numbers.
std::vector<double> info_numbers(const PlyFile& ply, const std::string& key, std::size_t count) {
  const std::string text = ply.header.info(key);
  if (text.empty()) return {};
  std::vector<double> numbers;
  Words words(text);
  while (numbers.size() <= count) {
    const std::string_view word = words.next();
    if (word.empty()) break;
    const auto number = parse_value(word);
    if (!number || !std::isfinite(*number)) break;
    numbers.push_back(*number);
  }
  if (numbers.size() != count || !words.rest().empty())
    throw input_error("{}: the header's \"{} {}\" should have {} numbers", ply.file, key, text, count);
  return numbers;
}

template <class Numbers>
std::string joined(const Numbers& numbers) {
  std::string text;
  for (const double number : numbers) text += " " + format_number(number);
  return text;
}

// --- reading

std::optional<RangeGrid> grid_of(const PlyFile& ply, std::size_t points) {
  const PlyColumn* cells = ply.column("range_grid", "vertex_indices");
  if (cells == nullptr || !cells->property.list) return std::nullopt;
  const PlyTable& table = *ply.table("range_grid");
  const std::vector<double> columns = info_numbers(ply, "num_cols", 1);
  const std::vector<double> rows = info_numbers(ply, "num_rows", 1);
  constexpr double most = std::numeric_limits<int>::max();
  const bool sizes = !columns.empty() && !rows.empty() && columns[0] >= 1 && rows[0] >= 1 &&
                     columns[0] <= most && rows[0] <= most && std::floor(columns[0]) == columns[0] &&
                     std::floor(rows[0]) == rows[0];
  if (!sizes || columns[0] * rows[0] != static_cast<double>(table.rows()))
    throw line_error(
        ply.file, table.element.header_line,
        "element \"range_grid\" has {} rows, but obj_info num_cols and num_rows do not say {} cells",
        table.rows(), table.rows());
  if (points > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw input_error("{}: has too many points for a range grid", ply.file);
  RangeGrid grid{static_cast<int>(rows[0]), static_cast<int>(columns[0]), {}};
  grid.cells.reserve(table.rows());
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto entries = cells->row(i);
    if (entries.size() > 1)
      throw ply.row_error(table, i, "a cell of the range grid holds more than one point");
    grid.cells.push_back(entries.empty() ? RangeGrid::missing : static_cast<std::int32_t>(entries[0]));
  }
  return grid;
}

ScanView view_of(const PlyFile& ply, bool has_grid) {
  const auto vector = [](const std::vector<double>& v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  if (const auto origin = info_numbers(ply, "view_origin", 3); !origin.empty())
    return {ScanView::Kind::origin, vector(origin)};
  if (const auto numbers = info_numbers(ply, "view_direction", 3); !numbers.empty()) {
    const Eigen::Vector3d direction = vector(numbers);
    if (std::abs(direction.norm() - 1) > 1e-6)
      throw input_error("{}: the header's view_direction has length {}, not 1", ply.file, direction.norm());
    return {ScanView::Kind::direction, direction};
  }
  if (has_mark(ply.header)) return {};
  if (const PlyTable* camera = ply.table("camera"); camera != nullptr && camera->rows() > 0) {
    const PlyColumn* x = camera->column("view_px");
    const PlyColumn* y = camera->column("view_py");
    const PlyColumn* z = camera->column("view_pz");
    if (x && y && z && !x->property.list && !y->property.list && !z->property.list) {
      const Eigen::Vector3d origin(x->values[0], y->values[0], z->values[0]);
      if (origin.allFinite()) return {ScanView::Kind::origin, origin};
    }
  }
  // Stanford's range grids come from a Cyberware scanner: parallel rays down the scan frame's z axis.
  if (has_grid) return {ScanView::Kind::direction, -Eigen::Vector3d::UnitZ()};
  return {};
}

std::optional<Rigid3> pose_of(const PlyFile& ply) {
  const std::vector<double> numbers = info_numbers(ply, "world_from_scan", 12);
  if (numbers.empty()) return std::nullopt;
  Rigid3 pose = Rigid3::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      pose.matrix()(row, column) = numbers[static_cast<std::size_t>(4 * row + column)];
  const Eigen::Matrix3d R = pose.linear();
  if (!((R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
        R.determinant() > 0))
    throw input_error("{}: the header's world_from_scan is no rigid motion", ply.file);
  return pose;
}

RangeScan scan_of(const PlyFile& ply) {
  RangeScan scan;
  scan.cloud = vertices_of(ply);
  scan.grid = grid_of(ply, scan.cloud.size());
  scan.view = view_of(ply, scan.grid.has_value());
  scan.world_from_scan = pose_of(ply);
  if (has_mark(ply.header)) {
    scan.file = unescaped(ply.header.info("scan_file"));
    if (const auto index = info_numbers(ply, "index_in_file", 1); !index.empty())
      scan.index_in_file = static_cast<int>(std::clamp(index[0], 0.0, 1e9));
    if (const auto spacing = info_numbers(ply, "spacing", 1); !spacing.empty()) scan.spacing = spacing[0];
  }
  return scan;
}

std::vector<PlyWanted> scan_columns() {
  std::vector<PlyWanted> wanted = vertex_columns();
  wanted.push_back({"range_grid", "vertex_indices", "vertex"});
  for (const char* name : {"view_px", "view_py", "view_pz"}) wanted.push_back({"camera", name});
  return wanted;
}

// --- reading in parts

constexpr std::uint64_t part_rows = 1 << 16;

/// A binary file with more points than may be held, whose vertices come first and have one size.
bool can_be_streamed(const PlyHeader& header, const ScanSource& source) {
  if (source.options.most_points == 0 || header.format == PlyFormat::ascii || header.elements.empty())
    return false;
  const PlyElement& first = header.elements.front();
  return first.name == "vertex" && first.count > source.options.most_points &&
         std::none_of(first.properties.begin(), first.properties.end(),
                      [](const PlyProperty& property) { return property.list; });
}

/// Its vertices part by part, each read as a PLY of its own; what follows them is left out.
RangeScan streamed_scan(const PlyHeader& header, const ScanSource& source) {
  const PlyElement& vertex = header.elements.front();
  std::uint64_t row_bytes = 0;
  for (const PlyProperty& property : vertex.properties) row_bytes += size_of(property.type);
  if (row_bytes == 0 || vertex.count > (source.bytes.size() - header.size) / row_bytes)
    throw byte_error(source.file, header.size,
                     "element \"vertex\" claims {} rows of {} bytes, but only {} bytes follow", vertex.count,
                     row_bytes, source.bytes.size() - header.size);
  PlyHeader part_header = header;
  part_header.elements = {vertex};
  std::optional<ScanBuilder> builder;
  VertexScales scales;
  for (std::uint64_t row = 0; row < vertex.count; row += part_rows) {
    const std::uint64_t rows = std::min(part_rows, vertex.count - row);
    part_header.elements[0].count = rows;
    part_header.size = static_cast<std::size_t>(header.size + row * row_bytes);
    const PlyFile part =
        parse_ply_body(source.file, part_header, source.bytes.substr(0, part_header.size + rows * row_bytes),
                       vertex_columns());
    const VertexSamples samples(part);
    if (!builder) {
      builder.emplace(source.file, samples.fields(), source.options.most_points);
      scales = samples.scales();
    }
    for (std::size_t i = 0; i < rows; ++i) builder->add(samples.sample(i));
  }
  RangeScan scan = builder->finish(scales.color, scales.intensity);
  PlyFile frame{source.file, header, {}};
  scan.view = view_of(frame, false);
  scan.world_from_scan = pose_of(frame);
  return scan;
}

// --- writing

void put_scan_infos(PlyBuilder& ply, const RangeScan& scan) {
  if (!scan.file.empty()) ply.obj_info("scan_file " + escaped(scan.file));
  ply.obj_info("index_in_file " + std::to_string(scan.index_in_file));
  ply.obj_info("spacing " + format_number(scan.spacing));
  if (scan.view.kind == ScanView::Kind::origin) ply.obj_info("view_origin" + joined(scan.view.vector));
  if (scan.view.kind == ScanView::Kind::direction) ply.obj_info("view_direction" + joined(scan.view.vector));
  if (scan.world_from_scan) {
    std::vector<double> numbers;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 4; ++column)
        numbers.push_back(scan.world_from_scan->matrix()(row, column));
    ply.obj_info("world_from_scan" + joined(numbers));
  }
  if (scan.grid) {
    ply.obj_info("num_cols " + std::to_string(scan.grid->columns));
    ply.obj_info("num_rows " + std::to_string(scan.grid->rows));
  }
}

void put_grid_rows(PlyBuilder& ply, const RangeGrid& grid) {
  for (const std::int32_t cell : grid.cells) {
    ply.put_byte(cell == RangeGrid::missing ? 0 : 1);
    if (cell != RangeGrid::missing) ply.put_int(cell);
  }
}

}  // namespace

std::vector<RangeScan> read_ply_scan(const ScanSource& source) {
  const PlyHeader header = parse_ply_header(source.file, source.bytes);
  if (can_be_streamed(header, source)) return {streamed_scan(header, source)};
  return {scan_of(parse_ply(source.file, source.bytes, scan_columns()))};
}

void write_scan_ply(const std::filesystem::path& file, const RangeScan& scan) {
  PlyBuilder ply;
  put_mark(ply, "scan");
  put_scan_infos(ply, scan);
  const VertexWriter vertices(scan.cloud);
  vertices.declare(ply);
  if (scan.grid) {
    ply.element("range_grid", scan.grid->cells.size());
    ply.list_property(PlyType::uint8, PlyType::int32, "vertex_indices");
  }
  ply.end_header(vertices.bytes() + (scan.grid ? 5 * scan.grid->cells.size() : 0));
  vertices.put_rows(ply);
  if (scan.grid) put_grid_rows(ply, *scan.grid);
  write_file(file, ply.bytes());
}

RangeScan read_scan_ply(const std::filesystem::path& file) {
  return scan_of(read_ply(file, scan_columns()));
}

void write_cloud_ply(const std::filesystem::path& file, const PointCloud& cloud) {
  PlyBuilder ply;
  put_mark(ply, "cloud");
  const VertexWriter vertices(cloud);
  vertices.declare(ply);
  ply.end_header(vertices.bytes());
  vertices.put_rows(ply);
  write_file(file, ply.bytes());
}

PointCloud read_cloud_ply(const std::filesystem::path& file) {
  return vertices_of(read_ply(file, vertex_columns()));
}

}  // namespace drape::io
