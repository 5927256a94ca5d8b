// Scan files made byte by byte: kinds that drape reads but does not write.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace drape::test {

/// Three points at 500000 + 0.01 k with k = 100, 123456789, 300 for x; intensities 0, 26214, 65535 (of
/// 65535).
[[nodiscard]] std::string las_bytes(int minor_version, int point_format);

/// A 16-bit grey PNG.
[[nodiscard]] std::string depth_png(int width, int height, const std::vector<std::uint16_t>& values);

/// An OpenEXR picture without compression: one float a pixel in the channel `channel`, and 9 in any `others`
/// (in the alphabet's order all of them). Its data window begins at (3, 5).
[[nodiscard]] std::string depth_exr(int width, int height, const std::vector<float>& values,
                                    const std::string& channel = "Z",
                                    const std::vector<std::string>& others = {});

/// Puts together an E57 as ASTM E2807 has it: pages with checksums, packets, and the XML that describes them.
struct E57Maker {
  struct Field {
    std::string xml;                    // the element of the prototype
    int bits = 0;                       // of each value
    std::vector<std::uint64_t> values;  // as stored
  };
  struct Scan {
    std::string xml;  // besides its points
    std::vector<Field> fields;
    std::size_t records_per_packet = 100;
    std::int64_t claimed_records = -1;  // other than there are
  };
  std::vector<Scan> scans;
  std::string photo;       // the bytes of a PNG
  std::string photo_pose;  // XML
  // In pixels, which are 10 micrometres wide.
  double focal_x_px = 3000, focal_y_px = 1500, center_x_px = 1.5, center_y_px = 1;

  [[nodiscard]] std::string bytes() const;
};

/// 300 points on a lattice of 20 rows and 15 columns: x a double, y a scaled integer of 9 bits, z a float;
/// point 7 is marked as invalid; intensity an integer within limits; a pose that turns by 90 degrees about z.
[[nodiscard]] E57Maker::Scan e57_scan_of_all_kinds();

/// One small whole file of every dialect that drape reads but does not write, by file name.
struct ScanFile {
  std::string name;
  std::string bytes;
  bool open_ended = false;  // text without counts: what ends with a whole line is whole
};
[[nodiscard]] std::vector<ScanFile> scanner_files();

}  // namespace drape::test
