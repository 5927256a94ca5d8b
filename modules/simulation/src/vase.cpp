// A thrown vase: a body of rotation in its shape, though not in its paint.
#include <cmath>
#include <numbers>

#include "solids.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

const Color ochre(0.76F, 0.55F, 0.30F);
const Color slip(0.88F, 0.83F, 0.70F);
const Color iron(0.25F, 0.13F, 0.08F);
const Color copper(0.24F, 0.44F, 0.38F);

Color vase_paint(const Vector3d& p) {
  const double around = std::atan2(p.y(), p.x());
  const double radius = p.head<2>().norm();
  if (p.z() > 176 && radius < 23) return grained(ochre, p, 5, 0.6);  // inside
  if (p.z() < 14 || std::abs(p.z() - 158) < 3 || std::abs(p.z() - 30) < 1.5) return iron;
  if (p.z() > 197 + 6 * std::sin(6 * around)) return grained(copper, p, 7, 0.5);
  if (p.z() > 130 && p.z() < 152) {  // a meander
    const double turn = std::fmod(around + pi, pi / 9) * 9 / pi;
    const double height = (p.z() - 130) / 22;
    return (turn < 0.22 || (height > 0.78 && turn < 0.8) || (height < 0.22 && turn > 0.3)) ? iron : slip;
  }
  // A runner's band: one large leaf after another, no two of the same size.
  const double place = (around + pi) / (2 * pi) * 7;
  const double size = 12 + 14 * cell_random({static_cast<int>(place), 0, 0}, 161);
  const double u = (place - std::floor(place) - 0.5) * 2 * pi / 7 * radius;
  const double leaf = std::hypot(u / (0.55 * size), (p.z() - 80 - 0.5 * u) / (1.6 * size));
  if (leaf < 1) return leaf > 0.88 || std::abs(u) < 0.8 ? iron : grained(copper, p, 6, 0.5);
  return grained(slip, p, 10, 0.4);
}

}  // namespace

ImplicitShape vase_shape() {
  const Revolution wall(
      {Vector2d(0, 3),    Vector2d(30, 3),   Vector2d(33, 0),   Vector2d(38, 0),   Vector2d(39, 5),
       Vector2d(35, 13),  Vector2d(44, 30),  Vector2d(60, 60),  Vector2d(68, 92),  Vector2d(62, 122),
       Vector2d(42, 148), Vector2d(27, 166), Vector2d(22, 184), Vector2d(24, 200), Vector2d(35, 214),
       Vector2d(37, 217), Vector2d(35, 219), Vector2d(31, 216), Vector2d(19, 199), Vector2d(17, 184),
       Vector2d(21, 165), Vector2d(37, 145), Vector2d(56, 120), Vector2d(61, 92),  Vector2d(54, 62),
       Vector2d(38, 32),  Vector2d(24, 16),  Vector2d(0, 12)},
      10);
  ImplicitShape vase = compose({{[wall](const Vector3d& p) { return wall.distance(p); }, 1, vase_paint}}, {},
                               BoundingBox(Vector3d(-72, -72, -1), Vector3d(72, 72, 222)));
  vase.pitch = 2;
  return vase;
}

}  // namespace drape::simulation
