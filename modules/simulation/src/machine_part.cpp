// A cast bearing bracket: a foot plate with bolt holes, a bored barrel on a web with ribs, a flanged side
// port, an eye and a grease nipple. Painted where it is cast, bright where it is machined.
#include <Eigen/Geometry>
#include <cmath>

#include "solids.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;

const Color enamel(0.24F, 0.42F, 0.36F);
const Color steel(0.72F, 0.73F, 0.74F);
const Color rust(0.45F, 0.24F, 0.12F);
const Color brass(0.80F, 0.64F, 0.28F);
const Color warning(0.85F, 0.62F, 0.12F);

constexpr double barrel_x = -16;
constexpr double barrel_z = 62;

Color cast(const Vector3d& p) {
  const double chipped = cloud_noise(p / 7, 141);
  if (chipped > 0.74) return mix(rust, steel, 8 * (chipped - 0.74));
  return grained(enamel, p, 4, 0.35);
}

Color machined(const Vector3d& p) {
  return grained(steel, {p.x() / 6, p.y(), p.z() / 6}, 2, 0.35);
}

/// The barrel's ends are faced.
Color barrel_paint(const Vector3d& p) {
  return std::abs(p.y()) > 35.5 ? machined(p) : cast(p);
}

Color flange_paint(const Vector3d& p) {
  if (p.x() > 69.5) return machined(p);
  return std::abs(std::remainder(std::atan2(p.y(), p.z() - barrel_z), 0.5)) < 0.12 ? warning : cast(p);
}

/// A plate across y between the planes, `half` thick to each side of y0.
Distance gusset(double y0, double half, const Vector3d& corner, const Vector3d& outward) {
  const Vector3d n = outward.normalized();
  return [=](const Vector3d& p) {
    const double slope = (p - corner).dot(n);
    const double d = carve(std::abs(p.y() - y0) - half, -slope, 1.5);
    return std::max(d, 6 - p.z());
  };
}

void add_barrel(std::vector<Part>& parts) {
  parts.push_back({box({barrel_x, 0, 30}, {24, 22, 30}, 2), 5, cast});
  parts.push_back({cylinder(Axis::y, {barrel_x, 0, barrel_z}, 34, 37, 1.2), 4, barrel_paint});
  // Ribs down to the plate, one on each side of the web, of different width.
  parts.push_back({[rib = gusset(8, 4, {-74, 0, 8}, {-0.72, 0, 0.69})](const Vector3d& p) {
                     return std::max(rib(p), p.x() - barrel_x);
                   },
                   3, cast});
  parts.push_back({[rib = gusset(-6, 5, {58, 0, 8}, {0.66, 0, 0.75})](const Vector3d& p) {
                     return std::max(rib(p), barrel_x - p.x());
                   },
                   3, cast});
}

void add_fittings(std::vector<Part>& parts) {
  parts.push_back({cylinder(Axis::x, {38, 0, barrel_z}, 15, 32, 1), 4, cast});
  parts.push_back({cylinder(Axis::x, {66, 0, barrel_z}, 27, 4.5, 0.8), 2.5, flange_paint});
  // The eye that it is lifted by.
  parts.push_back({box({-62, 27, 28}, {5, 15, 20}, 1.2), 3, cast});
  parts.push_back({cylinder(Axis::x, {-62, 27, 46}, 15, 5, 1.2), 1, cast});
  // The nipple on its boss.
  parts.push_back({limb({barrel_x - 9, 14, 90}, {barrel_x - 12, 14, 99}, 8, 7), 2, cast});
  parts.push_back({limb({barrel_x - 12, 14, 99}, {barrel_x - 16, 14, 112}, 3.4, 2.6), 0.8, plain(brass)});
  parts.push_back({ellipsoid({barrel_x - 16, 14, 112}, {3.8, 3.8, 3.2}), 0.8, plain(brass)});
}

std::vector<Part> holes() {
  std::vector<Part> cuts;
  for (const double x : {-66.0, 66.0})
    cuts.push_back({cylinder(Axis::z, {x, -34, 6}, 6.5, 20, 0.5), 0.8, machined});
  cuts.push_back({cylinder(Axis::z, {66, 34, 6}, 6.5, 20, 0.5), 0.8, machined});
  // A slot, to move the foot by.
  cuts.push_back({[](const Vector3d& p) {
                    const double x = p.x() - std::clamp(p.x(), 8.0, 30.0);
                    return std::max(std::hypot(x, p.y() - 36) - 5.5, std::abs(p.z() - 6) - 20);
                  },
                  0.8, machined});
  cuts.push_back({cylinder(Axis::y, {barrel_x, 0, barrel_z}, 19, 60, 0.5), 1, machined});
  cuts.push_back({cylinder(Axis::y, {barrel_x, -37, barrel_z}, 26, 9, 0.5), 0.8, machined});
  cuts.push_back({cylinder(Axis::x, {55, 0, barrel_z}, 9, 60, 0.5), 0.8, machined});
  for (int i = 0; i < 3; ++i) {
    const double turn = 0.5 + 2.0944 * i;
    cuts.push_back(
        {cylinder(Axis::x, {66, 20.5 * std::sin(turn), barrel_z + 20.5 * std::cos(turn)}, 3.2, 20, 0.3), 0.6,
         machined});
  }
  cuts.push_back({cylinder(Axis::x, {-62, 27, 46}, 8, 30, 0.5), 1, machined});
  return cuts;
}

}  // namespace

ImplicitShape machine_part_shape() {
  std::vector<Part> parts;
  parts.push_back({box({0, 0, 6}, {82, 46, 6}, 1.5), 1,
                   [](const Vector3d& p) { return p.z() < 0.8 ? machined(p) : cast(p); }});
  add_barrel(parts);
  add_fittings(parts);
  ImplicitShape part =
      compose(std::move(parts), holes(), BoundingBox(Vector3d(-84, -48, -1), Vector3d(84, 48, 117)));
  part.pitch = 1.2;
  part.deviation = 0.05;
  return part;
}

}  // namespace drape::simulation
