// A teapot of our own design: a thrown body and lid, a spout and a handle pulled from clay, painted in blues.
#include <numbers>

#include "distance_functions.hpp"
#include "implicit_shape.hpp"
#include "paint.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using std::numbers::pi;

const Color navy(0.08F, 0.14F, 0.34F);
const Color cobalt(0.12F, 0.27F, 0.60F);
const Color azure(0.25F, 0.47F, 0.76F);
const Color sky(0.42F, 0.64F, 0.86F);
const Color pale(0.62F, 0.80F, 0.93F);

/// Glaze that pools and thins, with iron speckles in it.
Color glazed(const Color& color, const Vector3d& p) {
  if (in_speckle(p, 3.1, 0.35, 11)) return mix(color, navy, 0.7);
  if (in_speckle(p, 5.3, 0.25, 21)) return mix(color, pale, 0.5);
  const double thickness = cloud_noise(p / 14, 31) - 0.5;
  return thickness > 0 ? mix(color, navy, 0.5 * thickness) : mix(color, sky, -0.5 * thickness);
}

/// A five-petalled flower with two leaves about (0, 0); (u, v) in millimetres on the unrolled wall.
Color flower(double u, double v, const Color& ground) {
  const double radius = std::hypot(u, v);
  const double around = std::atan2(v, u);
  const double petal = 19 * (0.6 + 0.4 * std::abs(std::cos(2.5 * (around - pi / 2))));
  if (radius < 3.2) return pale;
  if (radius < 5.2) return navy;
  if (radius < petal - 1.4) {
    const bool vein = std::abs(std::sin(2.5 * (around - pi / 2))) < 0.07 && radius > 8;
    return vein ? azure : mix(sky, pale, (radius - 5) / 12);
  }
  if (radius < petal) return navy;
  // Leaves: lens shapes to the left and right, below the flower's middle.
  for (const double side : {-1.0, 1.0}) {
    const Vector2d along = Vector2d(side * 0.92, -0.39);
    const Vector2d q = Vector2d(u, v) - 28 * along;
    const double s = q.dot(along);
    const double t = q.x() * along.y() - q.y() * along.x();
    const double half_width = 5.5 * (1 - s * s / 144);
    if (std::abs(s) < 12 && std::abs(t) < half_width)
      return std::abs(t) < 0.7 || std::abs(t) > half_width - 1 ? navy : azure;
  }
  return ground;
}

/// A fish with scales, swimming towards +u.
Color fish(double u, double v, const Color& ground) {
  const double outline = std::hypot(u / 24, v / 11);
  if (std::hypot(u - 15, v - 3) < 2.4) return std::hypot(u - 15, v - 3) < 1.3 ? navy : pale;
  if (outline < 0.92) {
    if (u > 9) return u < 10.2 ? navy : sky;
    const double column = std::floor(u / 5);
    const double row = v / 5 + (static_cast<int>(column) % 2 != 0 ? 0.5 : 0.0);
    const double scale = std::hypot(u - 5 * column - 5, 5 * (row - std::floor(row) - 0.5));
    return std::abs(scale - 4) < 0.55 ? navy : mix(sky, pale, (v + 11) / 22);
  }
  if (outline < 1) return navy;
  const double tail = -u - 20;
  if (tail > 0 && tail < 16 && std::abs(v) < 2 + 0.75 * tail)
    return std::abs(std::fmod(std::abs(v) + 0.3 * tail, 4.0)) < 0.9 ? navy : sky;
  return ground;
}

Color body_paint(const Vector3d& p) {
  const double around = std::atan2(p.y(), p.x());
  const double z = p.z();
  const double radius = p.head<2>().norm();
  if (z < 7.5) return glazed(navy, p);
  if (z < 22) {  // a wreath of petals above the foot
    const double tip = 9.5 + 11 * std::sqrt(std::abs(std::cos(12 * around)));
    if (z < tip - 1.3) return glazed(z < tip - 4 ? azure : sky, p);
    if (z < tip) return navy;
  }
  if (z > 86) return glazed(navy, p);
  if (z > 71) {  // waves between two lines
    if (z < 72.4 || z > 84.6) return navy;
    const double wave = z - 78.5 - 3 * std::sin(14 * around);
    if (std::abs(wave) < 1) return navy;
    const double nearest_dot = std::remainder(14 * around - (wave > 0 ? -pi / 2 : pi / 2), 2 * pi) / 14;
    if (std::hypot(nearest_dot * radius, z - 78.5 - (wave > 0 ? 2.2 : -2.2)) < 1.3) return cobalt;
    return glazed(wave > 0 ? pale : sky, p);
  }
  const Color ground = mix(cobalt, azure, (45 - z) / 60);
  const double front = std::remainder(around + pi / 2, 2 * pi) * radius;
  const double back = std::remainder(around - pi / 2, 2 * pi) * radius;
  return glazed(std::abs(front) < 50 ? flower(front, z - 46, ground) : fish(-back, z - 45, ground), p);
}

Color lid_paint(const Vector3d& p) {
  const double radius = p.head<2>().norm();
  const double around = std::atan2(p.y(), p.x());
  if (p.z() > 116) return glazed(p.z() > 128 ? pale : (p.z() > 126.6 ? navy : azure), p);
  if (p.z() < 97.5) return glazed(cobalt, p);
  const double petal = 14 + 18 * std::abs(std::cos(4 * around));
  if (std::abs(radius - petal) < 1) return navy;
  return glazed(radius < petal ? sky : azure, p);
}

Color spout_paint(const Tube& spout, const Vector3d& p) {
  const double along = spout.nearest(p).along;
  if (along > 0.9) return glazed(pale, p);
  if (along > 0.88 || (along > 0.80 && along < 0.815)) return navy;
  if (along > 0.815) return glazed(sky, p);
  const double stripe = std::abs(std::remainder(std::atan2(p.y(), p.z() - 20 - 0.6 * (p.x() - 40)), pi / 3));
  if (along > 0.45 && stripe < 0.16 * (along - 0.45) / 0.35) return glazed(sky, p);
  return glazed(mix(azure, cobalt, 2 * along), p);
}

Color handle_paint(const Tube& handle, const Vector3d& p) {
  const double band = handle.nearest(p).along * 11;
  const double within = band - std::floor(band);
  if (band > 1 && band < 10 && within < 0.28) return glazed(within < 0.06 || within > 0.22 ? navy : pale, p);
  return glazed(cobalt, p);
}

/// A strap, wider than thick.
Vector3d across_strap(const Vector3d& p) {
  return {p.x(), 0.7 * p.y(), p.z()};
}

}  // namespace

ImplicitShape teapot_shape() {
  const Revolution body(
      {Vector2d(0, 0.8), Vector2d(28, 0.8), Vector2d(31, 0), Vector2d(36.5, 0), Vector2d(38.5, 2.5),
       Vector2d(37.5, 7), Vector2d(46, 14), Vector2d(58, 27), Vector2d(64.5, 45), Vector2d(62.5, 62),
       Vector2d(54, 76), Vector2d(46, 84), Vector2d(43.2, 87.5), Vector2d(43.8, 89.6), Vector2d(42, 91),
       Vector2d(38, 91.2), Vector2d(0, 91.2)},
      12);
  const Revolution lid(
      {Vector2d(0, 90), Vector2d(34, 90), Vector2d(37, 91.5), Vector2d(40.6, 92.2), Vector2d(41.6, 94.2),
       Vector2d(39.6, 96.2), Vector2d(33, 100.2), Vector2d(20, 107), Vector2d(9, 111.5), Vector2d(6.3, 115),
       Vector2d(7.6, 119), Vector2d(11, 123.5), Vector2d(11.4, 128), Vector2d(8, 132), Vector2d(0, 133.6)},
      12);
  const Tube spout({Vector4d(36, 0, 31, 20), Vector4d(60, 0, 40, 17.5), Vector4d(78, 0, 57, 13),
                    Vector4d(88, 0, 76, 10), Vector4d(100, 0, 93, 8.6), Vector4d(112, 0, 103, 9.5)});
  const Tube bore({Vector4d(84, 0, 72, 4.5), Vector4d(90, 0, 79, 5.2), Vector4d(100, 0, 93, 5.9),
                   Vector4d(112, 0, 103, 6.8), Vector4d(120, 0, 108, 7.5)});
  const Tube handle({Vector4d(-46, 0, 79, 9), Vector4d(-68, 0, 90, 6.4), Vector4d(-90, 0, 86, 5.6),
                     Vector4d(-101, 0, 66, 5.6), Vector4d(-95, 0, 44, 5.6), Vector4d(-78, 0, 28, 6),
                     Vector4d(-52, 0, 23, 9)});
  // The lip is cut off nearly level, as a spout's is.
  const Vector3d lip(108, 0, 101);
  const Vector3d lip_normal = Vector3d(0.42, 0, 0.91).normalized();

  ImplicitShape teapot = compose(
      {{[body](const Vector3d& p) { return body.distance(p); }, 1, body_paint},
       {[lid](const Vector3d& p) { return lid.distance(p); }, 3, lid_paint},
       {[=](const Vector3d& p) { return carve(spout.nearest(p).distance, (lip - p).dot(lip_normal), 1.5); },
        7, [spout](const Vector3d& p) { return spout_paint(spout, p); }},
       {[handle](const Vector3d& p) { return handle.nearest(across_strap(p)).distance; }, 6,
        [handle](const Vector3d& p) { return handle_paint(handle, across_strap(p)); }}},
      {{[bore](const Vector3d& p) { return bore.nearest(p).distance; }, 1.5,
        [](const Vector3d& p) { return glazed(navy, p); }}},
      BoundingBox(Vector3d(-115, -68, -1), Vector3d(125, 68, 136)));
  return teapot;
}

}  // namespace drape::simulation
