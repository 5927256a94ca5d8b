#include "photo_plane.hpp"

#include <cmath>

#include "drape/base/error.hpp"

namespace drape::alignment {

PhotoPlane::PhotoPlane(int width, int height, const std::optional<KnownLens>& lens)
    : principal_px_(width / 2.0, height / 2.0) {
  if (!lens) return;
  const Eigen::Matrix3d& K = lens->K;
  if (!K.allFinite() || !(K(0, 0) > 0) || !(K(1, 1) > 0) || K(2, 2) != 1 || K(1, 0) != 0 || K(2, 0) != 0 ||
      K(2, 1) != 0)
    throw config_error("a photo's K must be [f 0 cx; 0 f cy; 0 0 1] with positive focal lengths");
  const std::size_t terms = lens->distortion.size();
  if (terms != 0 && terms != 4 && terms != 5)
    throw config_error("a photo's distortion has {} terms; it must have 4 or 5: k1 k2 p1 p2 [k3]", terms);
  principal_px_ = K.block<2, 1>(0, 2);
  focal_px_ = std::sqrt(K(0, 0) * K(1, 1));
  if (K(0, 0) != K(1, 1) || K(0, 1) != 0 || terms != 0) lens_ = lens;
}

std::optional<double> PhotoPlane::focal_px() const {
  return focal_px_;
}

// Brown's model, as OpenCV writes it.
Eigen::Vector2d PhotoPlane::distorted(const Eigen::Vector2d& x) const {
  const std::vector<double>& d = lens_->distortion;
  if (d.empty()) return x;
  const double r2 = x.squaredNorm();
  const double radial = 1 + r2 * (d[0] + r2 * (d[1] + r2 * (d.size() > 4 ? d[4] : 0)));
  return {x.x() * radial + 2 * d[2] * x.x() * x.y() + d[3] * (r2 + 2 * x.x() * x.x()),
          x.y() * radial + d[2] * (r2 + 2 * x.y() * x.y()) + 2 * d[3] * x.x() * x.y()};
}

Eigen::Vector2d PhotoPlane::to_photo(const Eigen::Vector2d& ideal_px) const {
  if (plain()) return ideal_px + principal_px_;
  return (lens_->K * distorted(ideal_px / *focal_px_).homogeneous()).head<2>();
}

Eigen::Vector2d PhotoPlane::to_ideal(const Eigen::Vector2d& photo_px) const {
  if (plain()) return photo_px - principal_px_;
  const Eigen::Matrix3d& K = lens_->K;
  const double y = (photo_px.y() - K(1, 2)) / K(1, 1);
  const Eigen::Vector2d target((photo_px.x() - K(0, 2) - K(0, 1) * y) / K(0, 0), y);
  Eigen::Vector2d x = target;
  // Fixed point: contracts for every distortion that does not fold the picture over.
  for (int i = 0; i < 30; ++i) {
    const Eigen::Vector2d error = target - distorted(x);
    x += error;
    if (error.squaredNorm() < 1e-20) break;
  }
  return *focal_px_ * x;
}

}  // namespace drape::alignment
