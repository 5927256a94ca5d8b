#include "field_of_view.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <utility>
#include <vector>

namespace drape::registration {
namespace {

constexpr std::size_t enough_cells = 4000;
constexpr std::size_t least_cells = 50;
constexpr double most_cells_off = 1;
constexpr double margin_cells = 2;
constexpr double least_border_missing = 0.9;
constexpr double least_forward = 0.3;  // cosine to the mean ray

struct Cell {
  Eigen::Vector2d place;  // row, column
  Eigen::Vector3d point;
};

std::vector<Cell> some_cells(const RangeScan& scan) {
  const std::size_t stride = 1 + scan.cloud.size() / enough_cells;
  std::vector<Cell> cells;
  std::size_t seen = 0;
  for (int row = 0; row < scan.grid->rows; ++row)
    for (int column = 0; column < scan.grid->columns; ++column) {
      const std::int32_t i = scan.grid->at(row, column);
      if (i != RangeGrid::missing && seen++ % stride == 0)
        cells.push_back({Eigen::Vector2d(row, column), scan.cloud.positions[static_cast<std::size_t>(i)]});
    }
  return cells;
}

// Whether nothing came back all along the border of the grid: the object is alone.
bool is_alone(const RangeGrid& grid) {
  int missing = 0;
  int all = 0;
  const auto count = [&](int row, int column) {
    missing += grid.at(row, column) == RangeGrid::missing ? 1 : 0;
    ++all;
  };
  for (int row = 0; row < grid.rows; ++row)
    for (const int column : {0, grid.columns - 1}) count(row, column);
  for (int column = 0; column < grid.columns; ++column)
    for (const int row : {0, grid.rows - 1}) count(row, column);
  return missing >= least_border_missing * all;
}

}  // namespace

FieldOfView::FieldOfView(const RangeScan& scan) : view_(scan.view) {
  if (!scan.grid || view_.kind == ScanView::Kind::unknown || !is_alone(*scan.grid)) return;
  const std::vector<Cell> cells = some_cells(scan);
  if (cells.size() < least_cells) return;
  Eigen::Vector3d ray = Eigen::Vector3d::Zero();
  for (const Cell& cell : cells) ray -= view_.towards_scanner(cell.point);
  if (!(ray.norm() > 0)) return;
  axes_ = Eigen::Quaterniond::FromTwoVectors(ray, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> products = Eigen::Matrix<double, 3, 2>::Zero();
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector2d>> rows;
  for (const Cell& cell : cells) {
    const auto place = place_of(cell.point);
    if (!place) return;
    rows.emplace_back(*place, cell.place);
    squares += *place * place->transpose();
    products += *place * cell.place.transpose();
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(squares);
  if (solver.info() != Eigen::Success || !solver.isPositive()) return;
  cell_from_place_ = solver.solve(products).transpose();
  double off = 0;
  for (const auto& [place, cell] : rows) off += (cell_from_place_ * place - cell).squaredNorm();
  known_ = std::sqrt(off / static_cast<double>(rows.size())) < most_cells_off;
  size_ = Eigen::Array2d(scan.grid->rows, scan.grid->columns);
}

std::optional<Eigen::Vector3d> FieldOfView::place_of(const Eigen::Vector3d& point) const {
  if (view_.kind == ScanView::Kind::direction) {
    const Eigen::Vector3d seen = axes_ * point;
    return Eigen::Vector3d(seen.x(), seen.y(), 1);
  }
  const Eigen::Vector3d seen = axes_ * (point - view_.vector);
  if (!(seen.z() > least_forward * seen.norm())) return std::nullopt;
  return Eigen::Vector3d(seen.x() / seen.z(), seen.y() / seen.z(), 1);
}

bool FieldOfView::contains(const Eigen::Vector3d& point) const {
  if (!known_) return false;
  const auto place = place_of(point);
  if (!place) return false;
  const Eigen::Array2d cell = cell_from_place_ * *place;
  return (cell >= margin_cells).all() && (cell <= size_ - 1 - margin_cells).all();
}

}  // namespace drape::registration
