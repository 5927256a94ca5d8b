#include "outline_warp.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "distance_field.hpp"

namespace drape::texturing {
namespace {

constexpr int cells_along = 8;           // of the grid, over the longer side of the outline
constexpr double bending_weight = 0.02;  // of a control's second difference, against a mean squared pixel
constexpr double robust_px = 1.5;        // residuals beyond this count less and less
constexpr double negligible_px = 0.15;   // outlines this close need no warp
constexpr int rounds = 6;
constexpr int most_pixels_along = 2048;  // larger stencils are thinned out
constexpr std::size_t least_points = 40;

std::array<double, 4> spline_weights(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
          t * t * t / 6};
}

struct Cell {
  int column;
  int row;
  std::array<double, 4> across;
  std::array<double, 4> down;
};

Cell cell_at(const Eigen::Vector2d& pixel, const Eigen::Vector2d& origin, double size, int columns,
             int rows) {
  const auto split = [&](double position, int controls) {
    const double cells = std::clamp(position / size, 0.0, controls - 3 - 1e-9);
    const int whole = static_cast<int>(cells);
    return std::pair{whole, cells - whole};
  };
  const auto [column, x] = split(pixel.x() - origin.x(), columns);
  const auto [row, y] = split(pixel.y() - origin.y(), rows);
  return {column, row, spline_weights(x), spline_weights(y)};
}

struct OutlinePoint {
  Eigen::Vector2d pixel;
  double distance;  // of the model's own field: within half a pixel
};

// Pixels along the model's outline, but not where the photo's frame cuts it or the stencil does not know.
std::vector<OutlinePoint> outline_points(const DistanceField& field, const Image8& photo) {
  constexpr int frame = 3;
  const ImageF& model = field.values();
  const int step = field.step();
  std::vector<OutlinePoint> points;
  for (int y = frame; y + frame < model.height(); ++y)
    for (int x = frame; x + frame < model.width(); ++x) {
      const float d = model.at(x, y);
      if (std::abs(d) > 0.75F * static_cast<float>(step)) continue;
      bool known = true;
      for (const auto& [dx, dy] : {std::pair{-2, 0}, {2, 0}, {0, -2}, {0, 2}, {0, 0}})
        known = known && photo.at((x + dx) * step, (y + dy) * step) != stencil::unknown;
      if (known) points.push_back({{x * step + 0.5, y * step + 0.5}, d});
    }
  return points;
}

void add_bending(Eigen::MatrixXd& normal, int columns, int rows) {
  const auto add = [&](std::array<int, 3> controls, std::array<double, 3> factors) {
    for (int axis = 0; axis < 2; ++axis)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          normal(2 * controls[i] + axis, 2 * controls[j] + axis) += bending_weight * factors[i] * factors[j];
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const int at = r * columns + c;
      if (c + 2 < columns) add({at, at + 1, at + 2}, {1, -2, 1});
      if (r + 2 < rows) add({at, at + columns, at + 2 * columns}, {1, -2, 1});
    }
  normal.diagonal().array() += 1e-5;
}

double mean_miss(const std::vector<OutlinePoint>& points, const DistanceField& photo, const OutlineWarp& warp,
                 double most_px) {
  double sum = 0;
  for (const OutlinePoint& p : points)
    sum += std::min(most_px + 1, std::abs(p.distance - photo.at(warp(p.pixel))));
  return sum / static_cast<double>(points.size());
}

}  // namespace

OutlineWarp::OutlineWarp(const Eigen::Vector2d& origin, double cell, int columns, int rows,
                         std::vector<Eigen::Vector2d> controls, double most_px)
    : origin_(origin),
      cell_(cell),
      columns_(columns),
      rows_(rows),
      controls_(std::move(controls)),
      most_px_(most_px) {}

Eigen::Vector2d OutlineWarp::shift_at(const Eigen::Vector2d& pixel) const {
  if (controls_.empty()) return Eigen::Vector2d::Zero();
  const Cell cell = cell_at(pixel, origin_, cell_, columns_, rows_);
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c)
      shift += cell.down[static_cast<std::size_t>(r)] * cell.across[static_cast<std::size_t>(c)] *
               controls_[static_cast<std::size_t>((cell.row + r) * columns_ + cell.column + c)];
  const double length = shift.norm();
  return length > most_px_ ? Eigen::Vector2d(shift * (most_px_ / length)) : shift;
}

SnappedOutline snapped_outline(const Image8& model, const Image8& photo, double most_px) {
  if (most_px <= 0 || photo.empty()) return {};
  const int step = std::max(1, std::max(model.width(), model.height()) / most_pixels_along);
  const DistanceField field(photo, step);
  const std::vector<OutlinePoint> points = outline_points(DistanceField(model, step), photo);
  if (points.size() < least_points) return {};
  const double before = mean_miss(points, field, {}, most_px);
  if (before < negligible_px) return {};

  Eigen::AlignedBox2d box;
  for (const OutlinePoint& p : points) box.extend(p.pixel);
  const double cell = std::max(1.0, box.sizes().maxCoeff() / cells_along);
  const int columns = static_cast<int>(std::ceil(box.sizes().x() / cell)) + 4;
  const int rows = static_cast<int>(std::ceil(box.sizes().y() / cell)) + 4;
  OutlineWarp warp;
  for (int round = 0; round < rounds; ++round) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(2 * columns * rows, 2 * columns * rows);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * columns * rows);
    const double share = 1 / static_cast<double>(points.size());
    for (const OutlinePoint& p : points) {
      const Eigen::Vector2d shift = warp.shift_at(p.pixel);
      const double miss = p.distance - field.at(p.pixel + shift);
      Eigen::Vector2d direction = field.slope_at(p.pixel + shift);
      if (std::abs(miss) > most_px + 1 || direction.norm() < 0.3) continue;
      direction.normalize();
      const double trust = 1 / (1 + miss * miss / (robust_px * robust_px));
      const double weight = share * trust * trust;  // Geman and McClure
      const double wanted = direction.dot(shift) + miss;
      const Cell at = cell_at(p.pixel, box.min(), cell, columns, rows);
      Eigen::Matrix<double, 32, 1> row;
      std::array<int, 32> unknowns{};
      for (int i = 0; i < 16; ++i) {
        const double w =
            at.down[static_cast<std::size_t>(i / 4)] * at.across[static_cast<std::size_t>(i % 4)];
        const int control = (at.row + i / 4) * columns + at.column + i % 4;
        for (int axis = 0; axis < 2; ++axis) {
          row[2 * i + axis] = w * direction[axis];
          unknowns[static_cast<std::size_t>(2 * i + axis)] = 2 * control + axis;
        }
      }
      for (int i = 0; i < 32; ++i) {
        right[unknowns[static_cast<std::size_t>(i)]] += weight * wanted * row[i];
        for (int j = 0; j < 32; ++j)
          normal(unknowns[static_cast<std::size_t>(i)], unknowns[static_cast<std::size_t>(j)]) +=
              weight * row[i] * row[j];
      }
    }
    add_bending(normal, columns, rows);
    const Eigen::VectorXd solved = normal.ldlt().solve(right);
    std::vector<Eigen::Vector2d> controls;
    for (Eigen::Index i = 0; i + 1 < solved.size(); i += 2) controls.emplace_back(solved[i], solved[i + 1]);
    warp = OutlineWarp(box.min(), cell, columns, rows, std::move(controls), most_px);
  }
  if (mean_miss(points, field, warp, most_px) >= before) return {};
  SnappedOutline snapped{warp, 0};
  for (const OutlinePoint& p : points)
    snapped.largest_px = std::max(snapped.largest_px, warp.shift_at(p.pixel).norm());
  return snapped;
}

}  // namespace drape::texturing
