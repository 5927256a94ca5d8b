// The scans of an E57 file (ASTM E2807): data3D. Lengths are metres, angles radians.
#include <cmath>
#include <optional>

#include "drape/base/error.hpp"
#include "drape/base/log.hpp"
#include "e57_file.hpp"
#include "e57_points.hpp"
#include "e57_pose.hpp"
#include "scan_builder.hpp"
#include "scan_formats.hpp"

namespace drape::io {
namespace {

/// Places of the fields that matter within a record; -1: not there.
struct Columns {
  explicit Columns(const std::vector<E57Field>& fields) {
    const auto find = [&](const char* name) {
      for (std::size_t k = 0; k < fields.size(); ++k)
        if (fields[k].name == name) return static_cast<int>(k);
      return -1;
    };
    x = find("cartesianX"), y = find("cartesianY"), z = find("cartesianZ");
    range = find("sphericalRange"), azimuth = find("sphericalAzimuth"),
    elevation = find("sphericalElevation");
    cartesian = x >= 0 && y >= 0 && z >= 0;
    spherical = range >= 0 && azimuth >= 0 && elevation >= 0;
    invalid = cartesian ? find("cartesianInvalidState") : find("sphericalInvalidState");
    row = find("rowIndex"), column = find("columnIndex");
    intensity = find("intensity"), intensity_invalid = find("isIntensityInvalid");
    red = find("colorRed"), green = find("colorGreen"), blue = find("colorBlue");
    nx = find("nor:normalX"), ny = find("nor:normalY"), nz = find("nor:normalZ");
  }
  int x, y, z, range, azimuth, elevation, invalid, row, column, intensity, intensity_invalid, red, green,
      blue, nx, ny, nz;
  bool cartesian, spherical;

  [[nodiscard]] bool has_grid() const { return row >= 0 && column >= 0; }
  [[nodiscard]] SampleFields fields() const {
    return {.normals = nx >= 0 && ny >= 0 && nz >= 0,
            .colors = red >= 0 && green >= 0 && blue >= 0,
            .intensities = intensity >= 0};
  }
};

/// From least..most to 0..1.
struct Limits {
  double least = 0;
  double most = 0;  // not above `least`: unknown
  [[nodiscard]] bool known() const { return most > least && std::isfinite(most - least); }
  [[nodiscard]] double unit(double value) const { return (value - least) / (most - least); }
};

/// What the scan says of a colour or of intensity, else what values the field can have.
Limits limits_of(const std::string& file, pugi::xml_node scan, const char* section, const char* least,
                 const char* most, const E57Field* field) {
  const pugi::xml_node node = scan.child(section);
  Limits limits{e57_number(file, node, least).value_or(0), e57_number(file, node, most).value_or(0)};
  if (!limits.known() && field != nullptr && !field->is_float && field->bits < 63)
    limits = {static_cast<double>(field->least) * field->scale + field->offset,
              static_cast<double>(field->most) * field->scale + field->offset};
  return limits;
}

class ScanReader57 {
 public:
  ScanReader57(const ScanSource& source, const E57Pages& pages, pugi::xml_node node)
      : source_(source), node_(node), points_(pages, node.child("points")), at_(points_.fields()) {}

  RangeScan read() {
    if (!at_.cartesian && !at_.spherical && points_.count() > 0)
      throw input_error("{}: the points have neither Cartesian nor spherical coordinates", source_.file);
    find_limits();
    ScanBuilder builder(source_.file, at_.fields(), source_.options.most_points);
    builder.expect(static_cast<std::size_t>(points_.count()));
    std::size_t invalid = 0;
    points_.for_each([&](std::span<const double> record) {
      if (at_.invalid >= 0 && value(record, at_.invalid) != 0) {
        ++invalid;
        return;
      }
      const Sample sample = sample_of(record);
      if (at_.has_grid())
        builder.add(sample, index(record, at_.row), index(record, at_.column));
      else
        builder.add(sample);
    });
    if (invalid > 0) log::info("{}: {} points marked as invalid are left out", source_.file, invalid);
    RangeScan scan = builder.finish(color_.known() ? 1 : 0, intensity_.known() ? 1 : 0);
    scan.world_from_scan = e57_pose(source_.file, node_);
    // The standard puts the scanner at the origin of its scan; only what scanners alone write is trusted in
    // that.
    if (at_.spherical || at_.has_grid()) scan.view = {ScanView::Kind::origin, Eigen::Vector3d::Zero()};
    return scan;
  }

 private:
  static double value(std::span<const double> record, int at) { return record[static_cast<std::size_t>(at)]; }
  /// Of a row or column; -1 for what is none.
  static std::int64_t index(std::span<const double> record, int at) {
    const double number = value(record, at);
    return number >= 0 && number < 1e9 ? static_cast<std::int64_t>(number) : -1;
  }
  const E57Field* field(int at) const {
    return at < 0 ? nullptr : &points_.fields()[static_cast<std::size_t>(at)];
  }

  void find_limits() {
    const std::string& file = source_.file;
    intensity_ = limits_of(file, node_, "intensityLimits", "intensityMinimum", "intensityMaximum",
                           field(at_.intensity));
    // One scale for the three channels: white stays white.
    color_ = limits_of(file, node_, "colorLimits", "colorRedMinimum", "colorRedMaximum", field(at_.red));
  }

  Sample sample_of(std::span<const double> record) const {
    Sample sample;
    if (at_.cartesian) {
      sample.position = {value(record, at_.x), value(record, at_.y), value(record, at_.z)};
    } else {
      const double level = value(record, at_.range) * std::cos(value(record, at_.elevation));
      sample.position = {level * std::cos(value(record, at_.azimuth)),
                         level * std::sin(value(record, at_.azimuth)),
                         value(record, at_.range) * std::sin(value(record, at_.elevation))};
    }
    const SampleFields has = at_.fields();
    if (has.normals) sample.normal = {value(record, at_.nx), value(record, at_.ny), value(record, at_.nz)};
    if (has.intensities) {
      sample.intensity = value(record, at_.intensity);
      if (intensity_.known()) sample.intensity = intensity_.unit(sample.intensity);
      if (at_.intensity_invalid >= 0 && value(record, at_.intensity_invalid) != 0) sample.intensity = 0;
    }
    if (has.colors) {
      sample.color = {value(record, at_.red), value(record, at_.green), value(record, at_.blue)};
      if (color_.known())
        for (double& channel : sample.color) channel = color_.unit(channel);
    }
    return sample;
  }

  const ScanSource& source_;
  pugi::xml_node node_;
  E57Points points_;
  Columns at_;
  Limits intensity_, color_;
};

}  // namespace

bool looks_like_e57(std::string_view bytes) {
  return bytes.starts_with("ASTM-E57");
}

std::vector<RangeScan> read_e57_scan(const ScanSource& source) {
  const E57Document document(source.file, source.bytes);
  std::vector<RangeScan> scans;
  for (const pugi::xml_node node : document.root().child("data3D").children("vectorChild"))
    scans.push_back(ScanReader57(source, document.pages(), node).read());
  return scans;
}

}  // namespace drape::io
