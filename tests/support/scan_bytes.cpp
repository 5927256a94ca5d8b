#include "scan_bytes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "drape/base/numbers.hpp"
#include "picture_bytes.hpp"

namespace drape::test {
namespace {

std::uint32_t crc32c_of(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int k = 0; k < 8; ++k) crc = (crc & 1U) != 0 ? crc >> 1 ^ 0x82F63B78U : crc >> 1;
  }
  return ~crc;
}

constexpr std::size_t page = 1024;
constexpr std::size_t payload = page - 4;

std::uint64_t physical(std::uint64_t logical) {
  return logical / payload * page + logical % payload;
}

/// All values of a field, one behind the other: a packet ends where its bytes do, within a value if need be.
std::string packed(const E57Maker::Field& field) {
  std::string bytes;
  int bit = 0;
  for (std::size_t i = 0; i < field.values.size(); ++i)
    for (int k = 0; k < field.bits; ++k, ++bit) {
      if (bit % 8 == 0) bytes += '\0';
      if ((field.values[i] >> k & 1U) != 0) bytes.back() = static_cast<char>(bytes.back() | 1 << bit % 8);
    }
  return bytes;
}

std::string section_of(const E57Maker::Scan& scan, std::uint64_t begin) {
  std::string packets;
  const std::size_t records = scan.fields[0].values.size();
  for (std::size_t at = 0; at < records; at += scan.records_per_packet) {
    const std::size_t end = std::min(records, at + scan.records_per_packet);
    std::string lengths, streams;
    for (const E57Maker::Field& field : scan.fields) {
      const std::string whole = packed(field);
      const std::size_t bits = static_cast<std::size_t>(field.bits);
      const std::size_t first = at * bits / 8;
      const std::size_t last = end == records ? whole.size() : end * bits / 8;
      const std::string stream = whole.substr(first, last - first);
      lengths += raw(static_cast<std::uint16_t>(stream.size()), false);
      streams += stream;
    }
    std::string rest = raw(static_cast<std::uint16_t>(scan.fields.size()), false) + lengths + streams;
    while (rest.size() % 4 != 0) rest += '\0';
    packets += std::string("\x01\0", 2) + raw(static_cast<std::uint16_t>(rest.size() + 3), false) + rest;
  }
  const std::string reserved(7, '\0');
  return "\x01" + reserved + raw(std::uint64_t{32 + packets.size()}, false) +
         raw(physical(begin + 32), false) + raw(std::uint64_t{0}, false) + packets;
}

}  // namespace

std::string las_bytes(int minor_version, int point_format) {
  constexpr std::array<std::size_t, 11> sizes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  constexpr std::array<std::size_t, 11> color_at{0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
  const std::size_t header_size = minor_version >= 4 ? 375 : minor_version == 3 ? 235 : 227;
  const std::size_t record_size = sizes[static_cast<std::size_t>(point_format)] + 3;  // three extra bytes
  std::string header(header_size, '\0');
  const auto put = [](std::string& bytes, std::size_t at, const std::string& value) {
    bytes.replace(at, value.size(), value);
  };
  put(header, 0, "LASF");
  header[24] = 1;
  header[25] = static_cast<char>(minor_version);
  put(header, 94, raw(static_cast<std::uint16_t>(header_size), false));
  put(header, 96, raw(static_cast<std::uint32_t>(header_size + 10), false));
  header[104] = static_cast<char>(point_format);
  put(header, 105, raw(static_cast<std::uint16_t>(record_size), false));
  if (minor_version < 4) put(header, 107, raw(3U, false));
  if (minor_version >= 4) put(header, 247, raw(std::uint64_t{3}, false));
  for (const std::size_t k : {0U, 1U, 2U}) put(header, 131 + 8 * k, raw(k == 0 ? 0.01 : 1.0, false));
  put(header, 155, raw(500000.0, false));
  std::string bytes = header + std::string(10, 'v');
  constexpr std::array<std::int32_t, 3> xs{100, 123456789, 300};
  constexpr std::array<std::uint16_t, 3> intensities{0, 26214, 65535};
  for (const std::size_t i : {0U, 1U, 2U}) {
    std::string record(record_size, '\0');
    put(record, 0, raw(xs[i], false));
    put(record, 4, raw(-2000, false));
    put(record, 8, raw(30, false));
    put(record, 12, raw(intensities[i], false));
    if (const std::size_t at = color_at[static_cast<std::size_t>(point_format)]; at != 0) {
      put(record, at, raw(std::uint16_t{65535}, false));
      put(record, at + 4, raw(std::uint16_t{13107}, false));
    }
    bytes += record;
  }
  return bytes;
}

std::string depth_png(int width, int height, const std::vector<std::uint16_t>& values) {
  std::string rows;
  for (int y = 0; y < height; ++y) {
    rows += '\0';
    for (int x = 0; x < width; ++x) rows += raw(values[static_cast<std::size_t>(y * width + x)], true);
  }
  const std::string header = raw(static_cast<std::uint32_t>(width), true) +
                             raw(static_cast<std::uint32_t>(height), true) + std::string("\x10\0\0\0\0", 5);
  return "\x89PNG\r\n\x1A\n" + png_chunk("IHDR", header) + png_chunk("IDAT", zlib_stored(rows)) +
         png_chunk("IEND", "");
}

std::string E57Maker::bytes() const {
  std::string logical(48, '\0');
  std::string data;
  for (const Scan& scan : scans) {
    const auto records = static_cast<std::int64_t>(scan.fields[0].values.size());
    data += "<vectorChild type=\"Structure\">" + scan.xml +
            "<points type=\"CompressedVector\" fileOffset=\"" + std::to_string(physical(logical.size())) +
            "\" recordCount=\"" + std::to_string(scan.claimed_records >= 0 ? scan.claimed_records : records) +
            "\"><prototype type=\"Structure\">";
    for (const Field& field : scan.fields) data += field.xml;
    data += "</prototype></points></vectorChild>\n";
    logical += section_of(scan, logical.size());
  }
  std::string pictures;
  const auto number = [](const std::string& name, double value) {
    return "<" + name + " type=\"Float\">" + format_number(value) + "</" + name + ">";
  };
  if (!photo.empty()) {
    pictures = "<images2D type=\"Vector\"><vectorChild type=\"Structure\">" + photo_pose +
               "<pinholeRepresentation type=\"Structure\"><pngImage type=\"Blob\" fileOffset=\"" +
               std::to_string(physical(logical.size())) + "\" length=\"" + std::to_string(photo.size()) +
               "\"/>" + number("focalLength", 1e-5 * focal_x_px) + number("pixelWidth", 1e-5) +
               number("pixelHeight", 1e-5 * focal_x_px / focal_y_px) +
               number("principalPointX", center_x_px) + number("principalPointY", center_y_px) +
               "</pinholeRepresentation></vectorChild></images2D>";
    logical += std::string(8, '\0') + raw(std::uint64_t{16 + photo.size()}, false) + photo;
  }
  const std::string xml =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<e57Root type=\"Structure\"><data3D type=\"Vector\">" +
      data + "</data3D>" + pictures + "</e57Root>\n";
  const std::uint64_t xml_at = physical(logical.size());
  logical += xml;
  while (logical.size() % payload != 0) logical += '\0';
  const std::string header = "ASTM-E57" + raw(1U, false) + raw(0U, false) +
                             raw(std::uint64_t{logical.size() / payload * page}, false) + raw(xml_at, false) +
                             raw(std::uint64_t{xml.size()}, false) + raw(std::uint64_t{page}, false);
  logical.replace(0, 48, header);
  std::string bytes;
  for (std::size_t at = 0; at < logical.size(); at += payload) {
    const std::string part = logical.substr(at, payload);
    bytes += part + raw(crc32c_of(part), true);
  }
  return bytes;
}

std::string depth_exr(int width, int height, const std::vector<float>& values, const std::string& channel,
                      const std::vector<std::string>& others) {
  std::vector<std::string> names = others;
  names.push_back(channel);
  std::sort(names.begin(), names.end());
  const auto end = [](const std::string& text) { return text + '\0'; };
  const auto attribute = [&](const char* name, const char* type, const std::string& value) {
    return end(name) + end(type) + raw(static_cast<std::int32_t>(value.size()), false) + value;
  };
  std::string channels;
  for (const std::string& name : names)
    channels += end(name) + raw(2, false) + raw(0, false) + raw(1, false) + raw(1, false);
  const auto box = [&](int x, int y) {
    return raw(x, false) + raw(y, false) + raw(x + width - 1, false) + raw(y + height - 1, false);
  };
  std::string bytes = "\x76\x2f\x31\x01" + raw(2, false) + attribute("channels", "chlist", end(channels)) +
                      attribute("compression", "compression", std::string(1, '\0')) +
                      attribute("dataWindow", "box2i", box(3, 5)) +
                      attribute("displayWindow", "box2i", box(0, 0)) +
                      attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                      attribute("pixelAspectRatio", "float", raw(1.0F, false)) +
                      attribute("screenWindowCenter", "v2f", raw(0.0F, false) + raw(0.0F, false)) +
                      attribute("screenWindowWidth", "float", raw(1.0F, false)) + '\0';
  const std::size_t line = 4 * names.size() * static_cast<std::size_t>(width);
  const std::size_t first = bytes.size() + 8 * static_cast<std::size_t>(height);
  for (int y = 0; y < height; ++y)
    bytes += raw(static_cast<std::uint64_t>(first + static_cast<std::size_t>(y) * (8 + line)), false);
  for (int y = 0; y < height; ++y) {
    bytes += raw(5 + y, false) + raw(static_cast<std::int32_t>(line), false);
    for (const std::string& name : names)
      for (int x = 0; x < width; ++x)
        bytes += raw(name == channel ? values[static_cast<std::size_t>(y * width + x)] : 9.0F, false);
  }
  return bytes;
}

E57Maker::Scan e57_scan_of_all_kinds() {
  E57Maker::Scan scan;
  scan.xml =
      "<pose type=\"Structure\"><rotation type=\"Structure\"><w type=\"Float\">0.70710678118654757</w><x "
      "type=\"Float\"/>"
      "<y type=\"Float\"/><z type=\"Float\">0.70710678118654757</z></rotation><translation "
      "type=\"Structure\">"
      "<x type=\"Float\">10</x><y type=\"Float\">20</y><z type=\"Float\">30</z></translation></pose>"
      "<intensityLimits type=\"Structure\"><intensityMinimum type=\"Integer\">-100</intensityMinimum>"
      "<intensityMaximum type=\"Integer\">200</intensityMaximum></intensityLimits>";
  scan.fields = {
      {"<cartesianX type=\"Float\"/>", 64, {}},
      {"<cartesianY type=\"ScaledInteger\" minimum=\"-150\" maximum=\"200\" scale=\"0.001\" offset=\"4\"/>",
       9,
       {}},
      {"<cartesianZ type=\"Float\" precision=\"single\"/>", 32, {}},
      {"<cartesianInvalidState type=\"Integer\" minimum=\"0\" maximum=\"2\"/>", 2, {}},
      {"<rowIndex type=\"Integer\" minimum=\"0\" maximum=\"19\"/>", 5, {}},
      {"<columnIndex type=\"Integer\" minimum=\"0\" maximum=\"14\"/>", 4, {}},
      {"<intensity type=\"Integer\" minimum=\"-100\" maximum=\"200\"/>", 9, {}},
      {"<colorRed type=\"Integer\" minimum=\"0\" maximum=\"255\"/>", 8, {}},
      {"<colorGreen type=\"Integer\" minimum=\"255\" maximum=\"255\"/>", 0, {}},
      {"<colorBlue type=\"Integer\" minimum=\"0\" maximum=\"255\"/>", 8, {}},
  };
  for (std::uint64_t k = 0; k < 300; ++k) {
    const std::array<std::uint64_t, 10> values{std::bit_cast<std::uint64_t>(0.5 * static_cast<double>(k)),
                                               k,
                                               std::bit_cast<std::uint32_t>(1e6F + static_cast<float>(k)),
                                               k == 7 ? 2U : 0U,
                                               k / 15,
                                               k % 15,
                                               k,
                                               k % 256,
                                               0,
                                               0};
    for (std::size_t f = 0; f < values.size(); ++f) scan.fields[f].values.push_back(values[f]);
  }
  return scan;
}

std::vector<ScanFile> scanner_files() {
  E57Maker e57;
  e57.scans.push_back(e57_scan_of_all_kinds());
  // A lattice of 2 x 2 with one gap, and a second scan without colours.
  const std::string header = "10 20 30\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n10 20 30 1\n";
  return {
      {"points.ptx",
       "2\n2\n" + header + "1 2 3 0.5 255 0 0\n0 0 0 0.5 0 0 0\n4 5 6 0.25 0 255 0\n7 8 9 1 0 0 255\n1\n2\n" +
           header + "1 2 3\n4 5 6\n",
       true},
      {"points.pts", "2\n1.5 2.5 3.5 -2048 255 0 0\n4.5 5.5 6.5 2047 0 255 0\n", true},
      {"points.las", las_bytes(2, 3)},
      {"points14.las", las_bytes(4, 7)},
      {"points.e57", e57.bytes()},
      {"points.3d", "100 200 300\n1 2 3\n-4.5 5.5 6.5\n", true},
      {"decimal_comma.csv", "X;Y;Z\n1,5;2,5;3,5\n4,5;5,5;6,5\n", true},
      {"depth.png", depth_png(4, 2, {1000, 0, 2000, 3000, 4000, 5000, 6000, 7000})},
      {"depth.exr", depth_exr(3, 2, {1, 2, 3, 4, 5, 6})},
      {"scan.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n3 0 1 2\n"},
  };
}

}  // namespace drape::test
