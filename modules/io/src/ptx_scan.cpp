// PTX, Leica's text of range grids: any number of scans, each with ten header lines.
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "drape/base/log.hpp"
#include "drape/base/numbers.hpp"
#include "rigid_part.hpp"
#include "scan_builder.hpp"
#include "scan_formats.hpp"
#include "text_lines.hpp"

namespace drape::io {
namespace {

struct PtxHeader {
  int columns = 0;
  int rows = 0;
  Rigid3 scanner = Rigid3::Identity();                            // lines 3 to 6: its place and axes
  Eigen::Matrix4d world_from_scan = Eigen::Matrix4d::Identity();  // lines 7 to 10, transposed
};

class PtxReader {
 public:
  explicit PtxReader(const ScanSource& source) : source_(source), lines_(source.bytes) {}

  std::vector<RangeScan> read() {
    std::vector<RangeScan> scans;
    while (lines_.next_filled()) scans.push_back(read_one());
    if (!lines_.ended())
      log::warn("{}: the last line has no line end: the file may be truncated", source_.file);
    return scans;
  }

 private:
  RangeScan read_one() {
    const PtxHeader header = read_header();
    const std::size_t first_line = lines_.number() + 1;
    // "0 0 0" and a line end, but for the last.
    const std::size_t cells =
        static_cast<std::size_t>(header.columns) * static_cast<std::size_t>(header.rows);
    if (cells > (lines_.rest().size() + 1) / 6)
      throw line_error(source_.file, lines_.number(),
                       "the scan claims {} x {} points, but only {} bytes follow", header.columns,
                       header.rows, lines_.rest().size());
    const Eigen::Matrix3d linear = header.world_from_scan.topLeftCorner<3, 3>();
    const bool rigid = is_rotation(linear, 1e-3);
    RangeScan scan = read_points(header, cells, !rigid);
    place(scan, header, rigid, first_line);
    return scan;
  }

  void place(RangeScan& scan, const PtxHeader& header, bool rigid, std::size_t first_line) const {
    const Eigen::Vector3d eye = header.scanner.translation();
    if (!rigid) {
      log::warn("{}:{}: the scan's matrix is no rigid motion; its points were transformed by it",
                source_.file, first_line - 1);
      scan.view = {ScanView::Kind::origin, eye};
      scan.world_from_scan = Rigid3::Identity();
      return;
    }
    const Rigid3 pose = nearest_rigid(header.world_from_scan);
    scan.view = {ScanView::Kind::origin, pose.inverse() * eye};
    scan.world_from_scan = pose;
    const double turned = Eigen::AngleAxisd(pose.linear().transpose() * header.scanner.linear()).angle();
    const double moved = (pose.translation() - eye).norm();
    if (turned > 1e-3 || moved > 1e-3 * (1 + eye.norm()))
      log::warn(
          "{}:{}: the scan's matrix and its scanner lines differ by {:.3g} units and {:.3g} degrees: it may "
          "have "
          "been exported in a coordinate system of its own; the matrix is used",
          source_.file, first_line - 1, moved, turned * 180 / M_PI);
  }

  PtxHeader read_header() {
    PtxHeader header;
    header.columns = read_count();
    next_line();
    header.rows = read_count();
    std::array<std::array<double, 3>, 4> place{};
    for (auto& row : place) {
      next_line();
      row = numbers<3>();
    }
    header.scanner.translation() = Eigen::Vector3d(place[0].data());
    Eigen::Matrix3d axes;
    for (int k = 0; k < 3; ++k) axes.col(k) = Eigen::Vector3d(place[static_cast<std::size_t>(k) + 1].data());
    if (is_rotation(axes, 1e-2)) header.scanner.linear() = axes;
    for (int k = 0; k < 4; ++k) {
      next_line();
      header.world_from_scan.col(k) = Eigen::Vector4d(numbers<4>().data());
    }
    if ((header.world_from_scan.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-9)
      throw line_error(source_.file, lines_.number(), "the last column of the scan's matrix must be 0 0 0 1");
    if (std::abs(header.world_from_scan.determinant()) < 1e-12)
      throw line_error(source_.file, lines_.number(), "the scan's matrix has no inverse");
    return header;
  }

  void next_line() {
    if (!lines_.next_filled())
      throw line_error(source_.file, lines_.number(), "the file ends within the header of a scan");
  }

  int read_count() const {
    Words words(lines_.line());
    const auto count = parse_integer(words.next());
    if (!count || *count < 1 || *count > 100'000'000 || !words.rest().empty())
      throw line_error(source_.file, lines_.number(), "{} is no number of columns or rows",
                       shown(lines_.line()));
    return static_cast<int>(*count);
  }

  template <std::size_t count>
  std::array<double, count> numbers() const {
    std::array<double, count> values{};
    Words words(lines_.line());
    for (double& value : values) {
      const auto number = parse_value(words.next());
      if (!number || !std::isfinite(*number))
        throw line_error(source_.file, lines_.number(), "{} should be {} numbers", shown(lines_.line()),
                         count);
      value = *number;
    }
    if (!words.rest().empty()) throw line_error(source_.file, lines_.number(), "more than {} numbers", count);
    return values;
  }

  /// The numbers of a point's line: 3 (place), 4 (intensity), 7 (colour) or 10 (normal).
  std::size_t read_point(std::array<double, 10>& values) const {
    Words words(lines_.line());
    std::size_t count = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const auto value = parse_value(word);
      if (!value) throw line_error(source_.file, lines_.number(), "{} is no number", shown(word));
      if (count == values.size()) throw line_error(source_.file, lines_.number(), "more than 10 numbers");
      values[count++] = *value;
    }
    if (count != 3 && count != 4 && count != 7 && count != 10)
      throw line_error(source_.file, lines_.number(), "has {} numbers; a point has 3, 4, 7 or 10", count);
    return count;
  }

  /// Column by column; a cell without a point is 0 0 0.
  RangeScan read_points(const PtxHeader& header, std::size_t cells, bool transform) {
    std::optional<ScanBuilder> builder;
    std::size_t width = 0;
    std::array<double, 10> values{};
    for (std::size_t i = 0; i < cells; ++i) {
      if (!lines_.next_filled())
        throw line_error(source_.file, lines_.number(), "the file ends after {} of the scan's {} points", i,
                         cells);
      const std::size_t count = read_point(values);
      Sample sample;
      sample.position = Eigen::Vector3d(values.data());
      if (sample.position.isZero(0)) continue;
      if (!builder) {
        width = count;
        builder.emplace(source_.file, SampleFields{width == 10, width >= 7, width >= 4},
                        source_.options.most_points);
        builder->expect(cells - i);
        builder->set_grid(header.rows, header.columns);
      }
      if (count != width)
        throw line_error(source_.file, lines_.number(), "has {} numbers, but the scan's first point has {}",
                         count, width);
      sample.intensity = values[3];
      sample.color = Eigen::Vector3d(values.data() + 4);
      sample.normal = Eigen::Vector3d(values.data() + 7);
      if (transform) sample.position = (header.world_from_scan * sample.position.homogeneous()).head<3>();
      const auto rows = static_cast<std::size_t>(header.rows);
      builder->add(sample, static_cast<std::int64_t>(i % rows), static_cast<std::int64_t>(i / rows));
    }
    return builder ? builder->finish(255) : RangeScan{};
  }

  const ScanSource& source_;
  TextLines lines_;
};

}  // namespace

std::vector<RangeScan> read_ptx_scan(const ScanSource& source) {
  return PtxReader(source).read();
}

}  // namespace drape::io
