#include "view_projection.hpp"

#include <Eigen/Geometry>

namespace drape::registration {

ViewProjection::ViewProjection(const ScanView& view, const Eigen::Vector3d& axis) : view_(view) {
  if (view.kind == ScanView::Kind::direction) {
    axes_.row(0) = view.vector.unitOrthogonal();
    axes_.row(1) = view.vector.cross(axes_.row(0).transpose());
    axes_.row(2) = view.vector;
  } else {
    axes_ = Eigen::Quaterniond::FromTwoVectors(axis, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  }
}

}  // namespace drape::registration
