#include "lattice_view.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace drape::ingest {
namespace {

// Gradient of a value over space by least squares; directions in which the points hardly extend get none.
Eigen::Vector3d gradient(const Eigen::Matrix3d& scatter, const Eigen::Vector3d& moment) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double extent = solver.eigenvalues()[i];
    if (extent <= 1e-9 * solver.eigenvalues()[2]) continue;
    const Eigen::Vector3d axis = solver.eigenvectors().col(i);
    result += axis * (axis.dot(moment) / extent);
  }
  return result;
}

// Sum over the lattice's squares of (area vector) * (position - centroid): positive where the surface bulges
// to the side that its (right x down) normals point to.
double bulge(const RangeScan& scan, const Eigen::Vector3d& centroid, const Eigen::Vector3d& side) {
  const RangeGrid& grid = *scan.grid;
  const auto& points = scan.cloud.positions;
  double sum = 0;
  for (int row = 0; row + 1 < grid.rows; ++row)
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const auto p = grid.at(row, column);
      const auto right = grid.at(row, column + 1);
      const auto down = grid.at(row + 1, column);
      if (p < 0 || right < 0 || down < 0) continue;
      const Eigen::Vector3d area = (points[right] - points[p]).cross(points[down] - points[p]).normalized();
      sum += (area.dot(side) < 0 ? -1.0 : 1.0) * area.dot(points[p] - centroid);
    }
  return sum;
}

// Whether row and column are linear in the position, to within a cell: so for parallel rays only.
bool rays_are_parallel(const RangeScan& scan, const Eigen::Vector3d& right, const Eigen::Vector3d& down) {
  const RangeGrid& grid = *scan.grid;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  double count = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const auto index = grid.at(row, column);
      if (index < 0) continue;
      const Eigen::Vector3d& p = scan.cloud.positions[static_cast<std::size_t>(index)];
      const Eigen::Vector2d residual(column - right.dot(p), row - down.dot(p));
      mean += residual;
      squares += residual.cwiseAbs2();
      count += 1;
    }
  mean /= count;
  const Eigen::Vector2d variance = squares / count - mean.cwiseAbs2();
  return variance.maxCoeff() < 1.0;
}

}  // namespace

ScanView view_or_lattice_axis(const RangeScan& scan) {
  if (scan.view.kind != ScanView::Kind::unknown || !scan.grid || scan.cloud.empty()) return scan.view;
  const auto& points = scan.cloud.positions;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const auto& p : points) centroid += p;
  centroid /= static_cast<double>(points.size());

  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Eigen::Vector3d row_moment = Eigen::Vector3d::Zero();
  Eigen::Vector3d column_moment = Eigen::Vector3d::Zero();
  const RangeGrid& grid = *scan.grid;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const auto index = grid.at(row, column);
      if (index < 0) continue;
      const Eigen::Vector3d p = points[index] - centroid;
      scatter += p * p.transpose();
      row_moment += row * p;
      column_moment += column * p;
    }
  const Eigen::Vector3d right = gradient(scatter, column_moment);
  const Eigen::Vector3d down = gradient(scatter, row_moment);
  const Eigen::Vector3d axis = right.cross(down);
  if (!(axis.norm() > 0) || !axis.allFinite() || !rays_are_parallel(scan, right, down)) return scan.view;
  const Eigen::Vector3d side = axis.normalized();
  return {ScanView::Kind::direction, bulge(scan, centroid, side) > 0 ? Eigen::Vector3d(-side) : side};
}

RayStep ray_step(const ScanView& view, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d step = to - from;
  const double along = -step.dot(view.towards_scanner(from));
  return {along, std::sqrt(std::max(0.0, step.squaredNorm() - along * along))};
}

double range_noise(const RangeScan& scan, const ScanView& view) {
  if (!scan.grid || view.kind == ScanView::Kind::unknown) return 0;
  const RangeGrid& grid = *scan.grid;
  const auto& points = scan.cloud.positions;
  constexpr std::size_t enough = 200'000;
  const int stride = std::max(1, static_cast<int>(points.size() / enough));
  std::vector<double> second_differences;
  for (int row = 0; row < grid.rows; row += stride)
    for (int column = 1; column + 1 < grid.columns; ++column) {
      const auto left = grid.at(row, column - 1);
      const auto middle = grid.at(row, column);
      const auto right = grid.at(row, column + 1);
      if (left < 0 || middle < 0 || right < 0) continue;
      second_differences.push_back(std::abs(ray_step(view, points[middle], points[left]).along +
                                            ray_step(view, points[middle], points[right]).along));
    }
  if (second_differences.empty()) return 0;
  const auto median = second_differences.begin() + static_cast<std::ptrdiff_t>(second_differences.size() / 2);
  std::nth_element(second_differences.begin(), median, second_differences.end());
  // 1.4826: from the median absolute value of a normal variable to its deviation; sqrt(6): of 1, -2, 1.
  return 1.4826 * *median / std::sqrt(6.0);
}

}  // namespace drape::ingest
