#include "scan_builder.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "attribute_scale.hpp"
#include "drape/base/error.hpp"
#include "drape/base/log.hpp"
#include "drape/geometry/bounding_box.hpp"

namespace drape::io {
namespace {

constexpr std::size_t most_indices = std::numeric_limits<std::int32_t>::max();

template <class Attribute>
void set(std::vector<Attribute>& values, std::size_t index, const Attribute& value) {
  if (index == values.size())
    values.push_back(value);
  else
    values[index] = value;
}

std::uint64_t mixed(std::uint64_t x) {
  x ^= x >> 33;
  x *= 0xFF51AFD7ED558CCDU;
  x ^= x >> 33;
  return x;
}

template <class Attribute>
void keep(std::vector<Attribute>& values, const std::vector<std::uint32_t>& kept) {
  if (values.empty()) return;
  for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
  values.resize(kept.size());
}

}  // namespace

ScanBuilder::ScanBuilder(std::string file, SampleFields fields, std::size_t most_points)
    : file_(std::move(file)),
      fields_(fields),
      most_points_(std::min(most_points == 0 ? most_indices : most_points, most_indices)) {}

void ScanBuilder::expect(std::size_t count) {
  count = std::min(count, most_points_ + 1);
  cloud_.positions.reserve(count);
  if (fields_.normals) cloud_.normals.reserve(count);
  if (fields_.colors) cloud_.colors.reserve(count);
  if (fields_.intensities) cloud_.intensities.reserve(count);
  if (fields_.confidences) cloud_.confidences.reserve(count);
}

void ScanBuilder::set_grid(int rows, int columns) {
  rows_ = std::max(rows_, rows);
  columns_ = std::max(columns_, columns);
  placed_ = true;
}

void ScanBuilder::put(std::size_t index, const Sample& sample) {
  set(cloud_.positions, index, sample.position);
  if (fields_.normals) set(cloud_.normals, index, unit_normal(sample.normal));
  if (fields_.colors) set(cloud_.colors, index, Eigen::Vector3f(sample.color.cast<float>()));
  if (fields_.intensities) set(cloud_.intensities, index, static_cast<float>(sample.intensity));
  if (fields_.confidences) set(cloud_.confidences, index, clamped_confidence(sample.confidence));
}

void ScanBuilder::add(const Sample& sample) {
  if (!sample.position.allFinite()) return;
  ++seen_;
  if (voxel_ == 0) {
    put(cloud_.size(), sample);
    if (cloud_.size() > most_points_) begin_thinning();
    return;
  }
  std::uint32_t& slot = slot_of(sample.position);
  if (slot != 0) {
    if (from_centre(sample.position) < from_centre(cloud_.positions[slot - 1])) put(slot - 1, sample);
    return;
  }
  slot = static_cast<std::uint32_t>(cloud_.size() + 1);
  put(cloud_.size(), sample);
  if (cloud_.size() > most_points_) coarsen();
}

void ScanBuilder::add(const Sample& sample, std::int64_t row, std::int64_t column) {
  constexpr std::int64_t most = std::numeric_limits<int>::max();
  const std::size_t before = cloud_.size();
  add(sample);
  if (voxel_ != 0 || cloud_.size() == before) return;
  if (row < 0 || column < 0 || row >= most || column >= most)
    throw input_error("{}: a point claims row {} and column {} of the scan's grid", file_, row, column);
  set_grid(static_cast<int>(row) + 1, static_cast<int>(column) + 1);
  cells_.push_back({static_cast<std::int32_t>(row), static_cast<std::int32_t>(column)});
}

ScanBuilder::Voxel ScanBuilder::voxel_of(const Eigen::Vector3d& position) const {
  constexpr double most = 4e18;
  return ((position - corner_) / voxel_).array().floor().max(-most).min(most).cast<std::int64_t>();
}

double ScanBuilder::from_centre(const Eigen::Vector3d& position) const {
  const Eigen::Array3d cells = (position - corner_).array() / voxel_;
  return (cells - cells.floor() - 0.5).matrix().squaredNorm();
}

std::uint32_t& ScanBuilder::slot_of(const Eigen::Vector3d& position) {
  const Voxel voxel = voxel_of(position);
  std::uint64_t hash = 0;
  for (const std::int64_t k : voxel) hash = mixed(hash + static_cast<std::uint64_t>(k) + 0x9E3779B97F4A7C15U);
  for (std::size_t at = hash & (slots_.size() - 1);; at = (at + 1) & (slots_.size() - 1))
    if (slots_[at] == 0 || voxel_of(cloud_.positions[slots_[at] - 1]) == voxel) return slots_[at];
}

void ScanBuilder::begin_thinning() {
  const BoundingBox box = bounding_box(cloud_.positions);
  corner_ = box.min();
  // A surface that fills the box's largest side would have about this distance between its points.
  voxel_ = std::max(box.diagonal().maxCoeff() / std::sqrt(static_cast<double>(most_points_)),
                    std::numeric_limits<double>::min()) /
           2;
  slots_.resize(std::bit_ceil(2 * most_points_ + 4));
  cells_ = {};
  coarsen();
}

void ScanBuilder::coarsen() {
  do {
    voxel_ *= 2;
    std::fill(slots_.begin(), slots_.end(), 0);
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      std::uint32_t& slot = slot_of(cloud_.positions[i]);
      if (slot == 0 || from_centre(cloud_.positions[i]) < from_centre(cloud_.positions[slot - 1]))
        slot = static_cast<std::uint32_t>(i + 1);
    }
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t slot : slots_)
      if (slot != 0) kept.push_back(slot - 1);
    std::sort(kept.begin(), kept.end());
    keep(cloud_.positions, kept);
    keep(cloud_.normals, kept);
    keep(cloud_.colors, kept);
    keep(cloud_.intensities, kept);
    keep(cloud_.confidences, kept);
  } while (cloud_.size() > most_points_ - most_points_ / 4);
  std::fill(slots_.begin(), slots_.end(), 0);
  for (std::size_t i = 0; i < cloud_.size(); ++i)
    slot_of(cloud_.positions[i]) = static_cast<std::uint32_t>(i + 1);
}

void ScanBuilder::lattice_onto(RangeScan& scan) const {
  if (!placed_) return;
  const auto cells = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_);
  // A lattice that is almost all gaps is no lattice, but a number that lies.
  if (cells > 64 * scan.cloud.size() + 4096) {
    log::warn("{}: a grid of {} x {} cells for {} points is left out", file_, rows_, columns_,
              scan.cloud.size());
    return;
  }
  RangeGrid grid{rows_, columns_, std::vector<std::int32_t>(cells, RangeGrid::missing)};
  for (std::size_t i = 0; i < cells_.size(); ++i)
    grid.cells[static_cast<std::size_t>(cells_[i].row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(cells_[i].column)] = static_cast<std::int32_t>(i);
  scan.grid = std::move(grid);
}

RangeScan ScanBuilder::finish(double color_full_scale, double intensity_full_scale) {
  RangeScan scan;
  scan.cloud = std::move(cloud_);
  scan.cloud.colors = scaled_colors(std::move(scan.cloud.colors), color_full_scale);
  scan.cloud.intensities = scaled_intensities(std::move(scan.cloud.intensities), intensity_full_scale);
  if (voxel_ == 0)
    lattice_onto(scan);
  else
    log::warn("{}: {} points are more than are kept at a time; thinned to {} on voxels of {:.4g} units",
              file_, seen_, scan.cloud.size(), voxel_);
  return scan;
}

}  // namespace drape::io
