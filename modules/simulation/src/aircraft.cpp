// A light aircraft with a braced high wing, as a model 0.23 m across: wings and tail are 3 to 5 mm thick,
// struts and undercarriage 2.6 mm. It stands on its wheels, the propeller towards -y.
#include <Eigen/Geometry>
#include <cmath>

#include "solids.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

const Color cream(0.90F, 0.87F, 0.78F);
const Color crimson(0.66F, 0.10F, 0.11F);
const Color glass(0.16F, 0.22F, 0.28F);
const Color rubber(0.11F, 0.11F, 0.12F);
const Color metal(0.62F, 0.64F, 0.66F);

/// A wing: an elliptic section of these half axes in the plane (along, up), cut off where `beyond` > 0.
double wing_distance(double along, double up, double half_chord, double half_thickness, double beyond) {
  const double x = along / half_chord;
  const double z = up / half_thickness;
  const double k = std::hypot(x, z);
  const double section =
      k < 1e-9 ? -half_thickness : k * (k - 1) / std::hypot(x / half_chord, z / half_thickness);
  return carve(section, -beyond, 2);
}

double main_wing(const Vector3d& p) {
  const double side = std::abs(p.x());
  const double half_chord = 18.5 - 0.055 * std::max(side - 45, 0.0);
  const double up = p.z() - 62 - 0.03 * side;
  // Cambered: the section's middle is higher than its edges.
  const double along = p.y() + 14 - 0.02 * side;
  return wing_distance(along, up + 0.006 * along * along - 1, half_chord, 2.6, side - 116);
}

double tail_plane(const Vector3d& p) {
  const double side = std::abs(p.x());
  return wing_distance(p.y() - 101 - 0.08 * side, p.z() - 52, 11.5 - 0.09 * side, 1.7, side - 40);
}

double fin(const Vector3d& p) {
  const double height = p.z() - 50;
  return wing_distance(p.y() - 96 - 0.42 * height, p.x(), 15 - 0.2 * height, 1.8,
                       std::max(height - 36, -height));
}

double propeller(const Vector3d& p) {
  static const Eigen::Matrix3d blade_from_object =
      Eigen::AngleAxisd(-0.6, Vector3d::UnitY()).toRotationMatrix().transpose();
  const Vector3d q = blade_from_object * (p - Vector3d(0, -85, 38));
  const double pitch = q.x() > 0 ? 0.45 : -0.45;  // both blades drive the same way
  return ellipsoid_distance({q.x(), q.y() + pitch * q.z(), q.z()}, Vector3d::Zero(), {37, 1.7, 4.2});
}

Color wing_paint(const Vector3d& p) {
  const double side = std::abs(p.x());
  if (side > 104) return crimson;
  if (std::abs(p.y() - 1.5) < 0.4 && side > 30) return metal;  // where the flaps begin
  // Letters on the left wing alone.
  if (p.x() > 44 && p.x() < 88 && std::abs(p.y() + 14) < 8) {
    const double stroke = value_noise({p.x() / 3.5, p.y() / 6, 0.5}, 151);
    if (stroke > 0.55) return rubber;
  }
  return grained(cream, p, 8, 0.15);
}

Color fuselage_paint(const Vector3d& p) {
  const double stripe = p.z() - 38 - 0.09 * (p.y() + 60);
  const bool windows = p.y() > -44 && p.y() < 16 && p.z() > 47 && p.z() < 58;
  if (windows && std::abs(std::remainder(p.y() + 3, 19)) > 1.6) return glass;
  if (std::abs(stripe) < 2.2) return crimson;
  if (stripe > 3 && stripe < 4) return crimson;
  if (p.y() < -80) return metal;
  return grained(cream, p, 8, 0.15);
}

Color fin_paint(const Vector3d& p) {
  return std::fmod(std::abs(p.z() + 0.5 * p.y()), 14) < 7 ? crimson : cream;
}

Color wheel_paint(const Vector3d& p) {
  const double front = p.y() < -40 ? std::hypot(p.y() + 66, p.z() - 6.5) : std::hypot(p.y() + 6, p.z() - 7.5);
  return front < 3.4 ? metal : rubber;
}

void add_undercarriage(std::vector<Part>& parts) {
  const Paint struts = plain(metal, 5, 0.2);
  for (const double side : {-1.0, 1.0}) {
    parts.push_back({limb({15 * side, -12, 29}, {62 * side, -14, 62.8}, 1.4, 1.3), 1, struts});
    parts.push_back({limb({9 * side, -7, 24}, {27 * side, -6, 7.5}, 2, 1.5), 2, struts});
    parts.push_back({cylinder(Axis::x, {28 * side, -6, 7.5}, 7.5, 2.6, 1.6), 0.5, wheel_paint});
  }
  parts.push_back({limb({0, -60, 26}, {0, -66, 7}, 1.8, 1.5), 2, struts});
  parts.push_back({cylinder(Axis::x, {0, -66, 6.5}, 6.5, 2.2, 1.4), 0.5, wheel_paint});
  // On one side only: the exhaust.
  parts.push_back({limb({8, -58, 24}, {9, -46, 15}, 2, 1.8), 1, plain(rubber)});
}

}  // namespace

ImplicitShape aircraft_shape() {
  const Tube hull({Vector4d(0, -78, 38, 11), Vector4d(0, -70, 38, 15), Vector4d(0, -42, 38, 18.5),
                   Vector4d(0, -5, 40, 19), Vector4d(0, 30, 43, 13.5), Vector4d(0, 70, 48, 7.5),
                   Vector4d(0, 108, 51, 3.6)});
  std::vector<Part> parts;
  parts.push_back({[hull](const Vector3d& p) { return hull.nearest(p).distance; }, 1, fuselage_paint});
  parts.push_back({ellipsoid({0, -13, 50}, {16, 36, 14}), 6, fuselage_paint});
  parts.push_back({ellipsoid({0, -86, 38}, {6.5, 11, 6.5}), 2, plain(crimson)});
  parts.push_back({propeller, 1, plain(rubber, 5, 0.1)});
  parts.push_back({main_wing, 2.5, wing_paint});
  parts.push_back({tail_plane, 1.5, plain(cream, 8, 0.15)});
  parts.push_back({fin, 2, fin_paint});
  add_undercarriage(parts);
  ImplicitShape aircraft =
      compose(std::move(parts), {}, BoundingBox(Vector3d(-119, -100, -1), Vector3d(119, 132, 90)));
  aircraft.pitch = 1;
  aircraft.deviation = 0.05;
  return aircraft;
}

}  // namespace drape::simulation
