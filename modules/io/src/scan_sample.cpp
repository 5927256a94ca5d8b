// What a large scan file holds, told from its header and a part of its points: runs of records, spread evenly
// over the file, are put behind a header that counts only them, and read as a small file of the same format.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>
#include <string>

#include "byte_fields.hpp"
#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/io/scan_files.hpp"
#include "ply.hpp"
#include "scan_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

constexpr std::uint64_t runs = 1024;
constexpr std::uint64_t run_points = 256;
constexpr std::uint64_t most_read_whole = 4 * runs * run_points;

// A file's records of one size, and the bytes that have to come before some of them.
struct Records {
  std::uint64_t begin = 0;
  std::uint64_t size = 0;
  std::uint64_t count = 0;
  std::string header;  // that counts `runs * run_points` records
  std::optional<BoundingBox> stated_box;
  int rows = 0;
  int columns = 0;
};

std::string line_of(std::string_view text, std::size_t& at) {
  const std::size_t end = std::min(text.find('\n', at), text.size() - 1);
  std::string line(text.substr(at, end + 1 - at));
  at = end + 1;
  return line;
}

// Replaces what follows the first word of a line.
std::string with_value(const std::string& line, const std::string& value) {
  return line.substr(0, line.find(' ')) + " " + value + "\n";
}

int grid_size(const PlyHeader& header, const char* key) {
  const auto size = parse_integer(header.info(key));
  return size && *size > 0 && *size < std::numeric_limits<int>::max() ? static_cast<int>(*size) : 0;
}

std::optional<Records> ply_records(const std::string& file, std::string_view bytes) {
  const PlyHeader header = parse_ply_header(file, bytes);
  const auto faces = [](const PlyElement& e) {
    return e.count > 0 && (e.name == "face" || e.name == "tristrips");
  };
  if (header.format == PlyFormat::ascii || header.elements.empty() ||
      header.elements.front().name != "vertex" ||
      std::any_of(header.elements.begin(), header.elements.end(), faces))
    return std::nullopt;
  const PlyElement& vertex = header.elements.front();
  Records records;
  for (const PlyProperty& property : vertex.properties) {
    if (property.list) return std::nullopt;
    records.size += size_of(property.type);
  }
  records.begin = header.size;
  records.count = vertex.count;
  if (const bool grid = header.elements.size() > 1 && header.elements[1].name == "range_grid"; grid) {
    records.rows = grid_size(header, "num_rows");
    records.columns = grid_size(header, "num_cols");
  }
  // The other elements go, and with them their properties.
  bool kept = true;
  bool counted = false;
  for (std::size_t at = 0; at < header.size;) {
    const std::string line = line_of(bytes.substr(0, header.size), at);
    Words words(std::string_view(line).substr(0, line.find_first_of("\r\n")));
    const std::string_view key = words.next();
    if (key == "element") kept = words.next() == "vertex";
    if (key == "element" && kept) {
      records.header += fmt::format("element vertex {}\n", runs * run_points);
      counted = true;
    } else if (key != "element" && (kept || key != "property")) {
      records.header += line;
    }
  }
  return counted ? std::optional(records) : std::nullopt;  // not where lines end in \r alone
}

std::optional<Records> pcd_records(std::string_view bytes) {
  Records records;
  std::uint64_t width = 0;
  std::uint64_t height = 1;
  std::vector<std::uint64_t> sizes;
  std::vector<std::uint64_t> counts;
  for (std::size_t at = 0; at < std::min<std::size_t>(bytes.size(), 1 << 16);) {
    const std::string line = line_of(bytes, at);
    Words words(std::string_view(line).substr(0, line.find_first_of("\r\n")));
    const std::string_view key = words.next();
    const auto numbers = [&] {
      std::vector<std::uint64_t> values;
      for (std::string_view word = words.next(); !word.empty(); word = words.next())
        values.push_back(
            static_cast<std::uint64_t>(std::max<std::int64_t>(0, parse_integer(word).value_or(0))));
      return values;
    };
    const auto first = [&] {
      const auto values = numbers();
      return values.empty() ? 0 : values.front();
    };
    if (key == "SIZE") sizes = numbers();
    if (key == "COUNT") counts = numbers();
    if (key == "WIDTH") width = first();
    if (key == "HEIGHT") height = first();
    if (key == "WIDTH" || key == "POINTS")
      records.header += with_value(line, std::to_string(runs * run_points));
    else
      records.header += key == "HEIGHT" ? with_value(line, "1") : line;
    if (key != "DATA") continue;
    if (words.next() != "binary") return std::nullopt;
    records.begin = at;
    break;
  }
  if (records.begin == 0 || (!counts.empty() && counts.size() != sizes.size())) return std::nullopt;
  for (std::size_t k = 0; k < sizes.size(); ++k) records.size += sizes[k] * (counts.empty() ? 1 : counts[k]);
  if (width > 1ULL << 31 || height > 1ULL << 31) return std::nullopt;
  records.count = width * height;
  if (height > 1) {
    records.rows = static_cast<int>(height);
    records.columns = static_cast<int>(width);
  }
  return records;
}

// LAS 1.4 R16, table 3.
std::optional<Records> las_records(std::string_view bytes) {
  if (bytes.size() < 375) return std::nullopt;
  Records records;
  const bool wide_count = bytes[25] >= 4;
  records.begin = load<std::uint32_t>(bytes, 96);
  records.size = load<std::uint16_t>(bytes, 105);
  records.count = wide_count ? load<std::uint64_t>(bytes, 247) : load<std::uint32_t>(bytes, 107);
  if (records.begin > bytes.size()) return std::nullopt;
  records.header = bytes.substr(0, records.begin);
  const std::uint64_t count = runs * run_points;
  std::memcpy(records.header.data() + 107, &count, 4);
  if (wide_count) std::memcpy(records.header.data() + 247, &count, 8);
  const auto number = [&](std::size_t at) { return load<double>(bytes, at); };
  const BoundingBox box(Eigen::Vector3d(number(187), number(203), number(219)),
                        Eigen::Vector3d(number(179), number(195), number(211)));
  if (!box.isEmpty() && box.min().allFinite() && box.max().allFinite()) records.stated_box = box;
  return records;
}

std::optional<Records> records_of(const std::string& file, std::string_view format, std::string_view bytes) {
  if (format == "PLY") return ply_records(file, bytes);
  if (format == "PCD") return pcd_records(bytes);
  if (format == "LAS") return las_records(bytes);
  return std::nullopt;
}

}  // namespace

std::optional<ScanSample> sample_scan(const std::filesystem::path& path) {
  const FileBytes file(path);
  const std::string_view bytes = file.view();
  const auto records = records_of(path.string(), scan_format(path).name, bytes);
  if (!records || records->size == 0 || records->count <= most_read_whole ||
      records->count > (bytes.size() - records->begin) / records->size)
    return std::nullopt;  // what is wrong with it, reading it whole will tell
  std::string part = records->header;
  part.reserve(part.size() + runs * run_points * records->size);
  for (std::uint64_t run = 0; run < runs; ++run) {
    const std::uint64_t first = (records->count - run_points) / (runs - 1) * run;
    part += bytes.substr(records->begin + first * records->size, run_points * records->size);
  }
  ScanSample sample;
  sample.points = records->count;
  sample.stated_box = records->stated_box;
  sample.rows = records->rows;
  sample.columns = records->columns;
  sample.run_points = run_points;
  sample.scan = std::move(parse_scans(path, part).front());
  return sample;
}

}  // namespace drape::io
