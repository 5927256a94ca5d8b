// A child's chair with arms, the same to the left and to the right of x = 0; its front looks to -y.
#include <Eigen/Geometry>
#include <cmath>

#include "solids.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;

const Color beech(0.74F, 0.54F, 0.33F);
const Color paint_red(0.68F, 0.20F, 0.16F);
const Color cloth(0.27F, 0.38F, 0.30F);
const Color stripe(0.85F, 0.80F, 0.62F);

Color wood(const Vector3d& p) {
  const Vector3d fibre(p.x() / 1.5, p.y() / 1.5, p.z() / 24);
  return mix(beech, Color(0.42F, 0.25F, 0.12F), 1.3 * cloud_noise(fibre, 171) - 0.3);
}

Color cushion_paint(const Vector3d& p) {
  return std::abs(std::remainder(std::abs(p.x()), 16)) < 2 ? stripe : grained(cloth, p, 3, 0.4);
}

/// The same on both sides.
Part on_both_sides(Distance distance, double fillet, Paint paint) {
  return {[distance = std::move(distance)](const Vector3d& p) {
            return distance({std::abs(p.x()), p.y(), p.z()});
          },
          fillet, std::move(paint)};
}

/// A back that leans: boards are upright in this frame.
Vector3d upright(const Vector3d& p) {
  return {p.x(), p.y() - 0.16 * (p.z() - 90), p.z()};
}

Distance leaning(Distance distance) {
  return [distance = std::move(distance)](const Vector3d& p) { return 0.97 * distance(upright(p)); };
}

}  // namespace

ImplicitShape chair_shape() {
  std::vector<Part> parts;
  parts.push_back({box({0, 0, 86}, {50, 46, 4}, 2), 1, wood});
  parts.push_back({[](const Vector3d& p) {
                     const double dome = 0.0015 * (p.x() * p.x() + p.y() * p.y());
                     return 0.95 * box_distance({p.x(), p.y(), p.z() + dome}, {0, -2, 93}, {44, 40, 6}, 4);
                   },
                   1, cushion_paint});
  parts.push_back(on_both_sides(limb({44, -40, 84}, {50, -46, 5}, 5.5, 4.2), 3, wood));
  parts.push_back(on_both_sides(limb({43, 38, 84}, {48, 52, 5}, 5.5, 4.2), 3, wood));
  parts.push_back(on_both_sides(limb({47.5, -43, 38}, {46.5, 45, 38}, 3, 3), 1.5, wood));
  parts.push_back({limb({-47, 1, 38}, {47, 1, 38}, 3, 3), 1.5, wood});
  parts.push_back(on_both_sides(leaning(box({45, 42, 142}, {5, 4, 58}, 2.5)), 2, wood));
  parts.push_back({leaning(box({0, 42, 190}, {50, 4, 12}, 3)), 2, plain(paint_red, 8, 0.3)});
  parts.push_back(on_both_sides(leaning(box({17, 42, 138}, {7, 2.4, 48}, 1.5)), 2, wood));
  parts.push_back(on_both_sides(limb({48, -34, 88}, {53, -34, 128}, 4, 3.5), 2, wood));
  parts.push_back(on_both_sides(box({53, 4, 131}, {7, 46, 3.5}, 2.5), 2, plain(paint_red, 8, 0.3)));
  // A heart in the top board, half in each side.
  const Distance heart = leaning([](const Vector3d& p) {
    const double x = std::abs(p.x());
    const double lobe = std::hypot(x - 3.2, p.z() - 192) - 4.2;
    const double tip = std::max(0.75 * x + 0.66 * (184.5 - p.z()) - 0.0, p.z() - 192);
    return std::max(std::min(lobe, tip), std::abs(p.y() - 42) - 20);
  });
  std::vector<Part> cuts = {{heart, 0.8, wood}, {[](const Vector3d& p) { return p.z(); }, 0.5, wood}};
  ImplicitShape chair =
      compose(std::move(parts), std::move(cuts), BoundingBox(Vector3d(-64, -54, -1), Vector3d(64, 68, 206)));
  chair.pitch = 1.4;
  chair.deviation = 0.05;
  return chair;
}

}  // namespace drape::simulation
