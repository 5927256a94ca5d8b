// One scan as a range scanner takes it: points, the lattice they were sampled on, and where they were seen
// from.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drape/geometry/point_cloud.hpp"
#include "drape/geometry/rigid3.hpp"

namespace drape {

/// The scanner's sampling lattice. Cell (row, column) holds the index of its point or `missing`.
struct RangeGrid {
  static constexpr std::int32_t missing = -1;

  int rows = 0;
  int columns = 0;
  std::vector<std::int32_t> cells;  // rows * columns, row by row

  [[nodiscard]] std::int32_t at(int row, int column) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
};

/// How the points were seen, in the scan's own frame.
struct ScanView {
  enum class Kind {
    unknown,
    origin,    // diverging rays from `vector`
    direction  // parallel rays that travel along `vector` (unit length, from the scanner towards the object)
  };
  Kind kind = Kind::unknown;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();

  /// Unit vector from a point towards the scanner; zero if unknown.
  [[nodiscard]] Eigen::Vector3d towards_scanner(const Eigen::Vector3d& point) const {
    if (kind == Kind::origin) return (vector - point).normalized();
    if (kind == Kind::direction) return -vector;
    return Eigen::Vector3d::Zero();
  }
};

struct RangeScan {
  std::string file;       // base name of the file it came from
  int index_in_file = 0;  // several scans may share a file
  PointCloud cloud;       // in the scan's own frame
  std::optional<RangeGrid> grid;
  ScanView view;
  double spacing = 0;                     // median distance of neighbouring samples; 0: not measured yet
  std::optional<Rigid3> world_from_scan;  // pose that the file itself states
};

}  // namespace drape
