#include "plane_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace drape::ingest {
namespace {

// The least root of x^3 - x^2 + b x - c, which has three real ones that are not negative and sum to 1: left
// of it the polynomial is concave and rises, so that Newton's steps from 0, the first of which leads to c /
// b, approach it and never pass it.
double least_eigenvalue(double b, double c) {
  double x = b > 0 ? c / b : 0.0;
  for (int round = 0; round < 12; ++round) {
    const double value = ((x - 1) * x + b) * x - c;
    const double slope = (3 * x - 2) * x + b;
    if (!(slope > 0) || !(value < 0)) break;
    const double step = value / slope;
    x -= step;
    if (-step < 1e-9) break;  // of 1: finer than the floats of the sums
  }
  return x;
}

}  // namespace

void PlaneFit::take_waiting() {
  constexpr std::size_t width = 4;
  using Lanes = Eigen::Array<float, width, 1>;
  count_ += static_cast<double>(waiting_count_);
  for (; waiting_count_ % width != 0; ++waiting_count_)
    for (auto& axis : waiting_) axis[waiting_count_] = 0;
  std::array<Lanes, 9> sums;
  for (Lanes& sum : sums) sum.setZero();
  for (std::size_t k = 0; k < waiting_count_; k += width) {
    const auto [x, y, z] = std::array{Lanes(Eigen::Map<const Lanes>(&waiting_[0][k])),
                                      Lanes(Eigen::Map<const Lanes>(&waiting_[1][k])),
                                      Lanes(Eigen::Map<const Lanes>(&waiting_[2][k]))};
    sums[0] += x;
    sums[1] += y;
    sums[2] += z;
    sums[3] += x * x;
    sums[4] += y * y;
    sums[5] += z * z;
    sums[6] += y * z;
    sums[7] += z * x;
    sums[8] += x * y;
  }
  const auto three = [&](std::size_t first) -> Eigen::Vector3d {
    return Eigen::Vector3f(sums[first].sum(), sums[first + 1].sum(), sums[first + 2].sum()).cast<double>();
  };
  sum_ += three(0);
  squares_ += three(3);
  products_ += three(6);
  waiting_count_ = 0;
}

Eigen::Vector3f PlaneFit::normal() {
  take_waiting();
  if (!(count_ > 0)) return Eigen::Vector3f::UnitZ();
  Eigen::Matrix3d covariance;
  covariance << squares_.x(), products_.z(), products_.y(),  //
      products_.z(), squares_.y(), products_.x(),            //
      products_.y(), products_.x(), squares_.z();
  covariance -= sum_ * (sum_ / count_).transpose();
  const double trace = covariance.trace();
  if (!(trace > 0) || !std::isfinite(trace)) return Eigen::Vector3f::UnitZ();
  covariance /= trace;
  const auto minor = [&](int i, int j) {
    return covariance(i, i) * covariance(j, j) - covariance(i, j) * covariance(j, i);
  };
  const double least =
      least_eigenvalue(minor(0, 1) + minor(0, 2) + minor(1, 2), std::max(0.0, covariance.determinant()));
  // Rows of C - least I lie in the plane: the longest of their cross products is the surest normal.
  const Eigen::Matrix3d in_plane = covariance - least * Eigen::Matrix3d::Identity();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d product = in_plane.row(i).cross(in_plane.row((i + 1) % 3));
    if (product.squaredNorm() > normal.squaredNorm()) normal = product;
  }
  // For a line of points the two small eigenvalues are equal, and the products vanish.
  if (!(normal.norm() > 1e-7))
    normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvectors().col(0);
  return normal.normalized().cast<float>();
}

}  // namespace drape::ingest
