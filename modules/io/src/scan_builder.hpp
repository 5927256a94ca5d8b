// Collects the samples of one scan as a reader comes by them, in bounded memory.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "drape/geometry/range_scan.hpp"

namespace drape::io {

/// What the samples of a scan have besides their positions.
struct SampleFields {
  bool normals = false;
  bool colors = false;
  bool intensities = false;
  bool confidences = false;
};

/// One sample in the file's own numbers.
struct Sample {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double intensity = 0;
  double confidence = 0;
};

/// Holds at most `most_points` samples (0: any number). With more, the samples fall into the cells of a voxel
/// grid, of which each keeps the sample nearest to its centre; the voxels double whenever they are too many,
/// so that a scan of unknown size and extent ends with between a quarter of `most_points` and all of them.
/// The result depends on the samples and their order alone. A thinned scan loses its lattice.
class ScanBuilder {
 public:
  ScanBuilder(std::string file, SampleFields fields, std::size_t most_points);

  /// So many samples come (or fewer); the caller knows that the bytes for them are there.
  void expect(std::size_t count);
  /// Samples that are not finite are left out.
  void add(const Sample& sample);
  /// The same, and its place on the lattice: 0-based, any size. Two samples of one cell: the later one
  /// counts.
  void add(const Sample& sample, std::int64_t row, std::int64_t column);
  /// At least this size, whatever cells are filled.
  void set_grid(int rows, int columns);

  [[nodiscard]] std::size_t size() const { return cloud_.size(); }

  /// Brings colours and intensities to 0..1 (attribute_scale.hpp says what 0 means for the full scales).
  [[nodiscard]] RangeScan finish(double color_full_scale = 0, double intensity_full_scale = 0);

 private:
  using Voxel = Eigen::Matrix<std::int64_t, 3, 1>;
  struct Cell {
    std::int32_t row, column;
  };

  [[nodiscard]] Voxel voxel_of(const Eigen::Vector3d& position) const;
  [[nodiscard]] double from_centre(const Eigen::Vector3d& position) const;
  /// The slot of a position's voxel: that of the point in it, or a free one.
  [[nodiscard]] std::uint32_t& slot_of(const Eigen::Vector3d& position);
  void put(std::size_t index, const Sample& sample);
  void begin_thinning();
  void coarsen();
  void lattice_onto(RangeScan& scan) const;

  std::string file_;
  SampleFields fields_;
  std::size_t most_points_;
  std::size_t seen_ = 0;
  PointCloud cloud_;         // raw colours and intensities
  std::vector<Cell> cells_;  // per point; empty without a lattice
  int rows_ = 0;
  int columns_ = 0;
  bool placed_ = false;  // the samples have cells

  double voxel_ = 0;  // edge; 0: not thinning
  Eigen::Vector3d corner_ = Eigen::Vector3d::Zero();
  std::vector<std::uint32_t> slots_;  // open addressing: index of a point + 1, or 0
};

}  // namespace drape::io
