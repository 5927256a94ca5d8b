// LAS 1.0 to 1.4, point formats 0 to 10 (ASPRS LAS specification 1.4 R16, sections 2.4 and 2.6).
#include <array>
#include <cmath>

#include "byte_fields.hpp"
#include "drape/base/log.hpp"
#include "scan_builder.hpp"
#include "scan_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

constexpr std::array<std::size_t, 11> record_bytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<std::size_t, 11> color_byte{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};  // 0: no colour
constexpr std::size_t shortest_header = 227;

struct LasHeader {
  std::uint64_t first_point = 0;  // byte
  std::uint64_t points = 0;
  std::size_t format = 0;
  std::size_t stride = 0;
  Eigen::Vector3d scale = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
};

Eigen::Vector3d vector_at(std::string_view bytes, std::size_t at) {
  return {load<double>(bytes, at), load<double>(bytes, at + 8), load<double>(bytes, at + 16)};
}

LasHeader read_header(const ScanSource& source) {
  const auto& [file, bytes, options] = source;
  if (bytes.size() < shortest_header)
    throw byte_error(file, bytes.size(), "the file ends within the LAS header of {} bytes", shortest_header);
  const int minor = static_cast<unsigned char>(bytes[25]);
  const auto header_size = load<std::uint16_t>(bytes, 94);
  if (bytes[24] != 1 || minor > 4)
    throw byte_error(file, 24, "LAS version {}.{} is not known (1.0 to 1.4 are)",
                     static_cast<unsigned char>(bytes[24]), minor);
  if (header_size < (minor >= 4 ? 375U : shortest_header) || header_size > bytes.size())
    throw byte_error(file, 94, "{} is no size of a LAS 1.{} header", header_size, minor);
  LasHeader header;
  header.first_point = load<std::uint32_t>(bytes, 96);
  header.format = static_cast<unsigned char>(bytes[104]);
  if (header.format & 0xC0U)
    throw input_error(
        "{}: the points are compressed (LAZ); decompress the file first: laszip -i in.laz -o out.las, or "
        "pdal translate in.laz out.las",
        file);
  if (header.format >= record_bytes.size())
    throw byte_error(file, 104, "point format {} is not known (0 to 10 are)", header.format);
  header.stride = load<std::uint16_t>(bytes, 105);
  if (header.stride < record_bytes[header.format])
    throw byte_error(file, 105, "points of format {} take {} bytes, but the header says {}", header.format,
                     record_bytes[header.format], header.stride);
  header.points = load<std::uint32_t>(bytes, 107);
  if (minor >= 4) header.points = load<std::uint64_t>(bytes, 247);
  header.scale = vector_at(bytes, 131);
  header.offset = vector_at(bytes, 155);
  if (!header.scale.allFinite() || !header.offset.allFinite() || (header.scale.array() == 0).any())
    throw byte_error(file, 131, "the scales and offsets of the points are no numbers");
  if (header.first_point < header_size || header.first_point > bytes.size())
    throw byte_error(file, 96, "the points begin at byte {}, which is not behind the header",
                     header.first_point);
  if (header.points > (bytes.size() - header.first_point) / header.stride)
    throw byte_error(file, minor >= 4 ? 247 : 107,
                     "the header claims {} points of {} bytes, but only {} bytes follow", header.points,
                     header.stride, bytes.size() - header.first_point);
  return header;
}

/// The point was deleted without being removed.
bool is_withheld(std::string_view record, std::size_t format) {
  return format < 6 ? (static_cast<unsigned char>(record[15]) & 0x80U) != 0
                    : (static_cast<unsigned char>(record[15]) & 0x04U) != 0;
}

}  // namespace

bool looks_like_las(std::string_view bytes) {
  return bytes.starts_with("LASF");
}

std::vector<RangeScan> read_las_scan(const ScanSource& source) {
  if (!looks_like_las(source.bytes))
    throw byte_error(source.file, 0, "is no LAS file: it does not start with LASF");
  const LasHeader header = read_header(source);
  const std::size_t color = color_byte[header.format];
  ScanBuilder builder(source.file, {.colors = color != 0, .intensities = true}, source.options.most_points);
  builder.expect(static_cast<std::size_t>(header.points));
  std::size_t withheld = 0;
  for (std::uint64_t i = 0; i < header.points; ++i) {
    const std::string_view record =
        source.bytes.substr(static_cast<std::size_t>(header.first_point + i * header.stride), header.stride);
    if (is_withheld(record, header.format)) {
      ++withheld;
      continue;
    }
    Sample sample;
    const Eigen::Vector3d steps(load<std::int32_t>(record, 0), load<std::int32_t>(record, 4),
                                load<std::int32_t>(record, 8));
    sample.position = steps.cwiseProduct(header.scale) + header.offset;
    sample.intensity = load<std::uint16_t>(record, 12);
    if (color != 0)
      sample.color = {double(load<std::uint16_t>(record, color)),
                      double(load<std::uint16_t>(record, color + 2)),
                      double(load<std::uint16_t>(record, color + 4))};
    builder.add(sample);
  }
  if (withheld > 0) log::info("{}: {} points marked as withheld are left out", source.file, withheld);
  return {builder.finish()};
}

}  // namespace drape::io
