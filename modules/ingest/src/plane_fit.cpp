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
    if (-step < 1e-12) break;
  }
  return x;
}

}  // namespace

Eigen::Vector3f PlaneFit::normal() const {
  if (!(count_ > 0)) return Eigen::Vector3f::UnitZ();
  const Eigen::Vector3d mean = sum_ / count_;
  Eigen::Matrix3d covariance;
  covariance << xx_, xy_, xz_, xy_, yy_, yz_, xz_, yz_, zz_;
  covariance -= mean * sum_.transpose();
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
