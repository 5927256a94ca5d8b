// The plane of least squares through a few points.
#pragma once

#include <Eigen/Core>

namespace drape::ingest {

/// Sums over points, given relative to a place nearby.
class PlaneFit {
 public:
  void add(const Eigen::Vector3d& p) {
    sum_ += p;
    xx_ += p.x() * p.x();
    xy_ += p.x() * p.y();
    xz_ += p.x() * p.z();
    yy_ += p.y() * p.y();
    yz_ += p.y() * p.z();
    zz_ += p.z() * p.z();
    count_ += 1;
  }

  /// Unit normal by total least squares (the covariance's least axis); its sign is arbitrary. Points that do
  /// not span a plane get some direction across their line, or z.
  [[nodiscard]] Eigen::Vector3f normal() const;

 private:
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
  double count_ = 0;
};

}  // namespace drape::ingest
