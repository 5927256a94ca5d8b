// A bust: the head of a woman with a bun and a plait over one shoulder, on a round plinth.
#include <cmath>

#include "solids.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

const Color marble(0.78F, 0.76F, 0.72F);
const Color skin(0.82F, 0.61F, 0.48F);
const Color rose(0.70F, 0.32F, 0.30F);
const Color chestnut(0.34F, 0.19F, 0.10F);
const Color auburn(0.52F, 0.29F, 0.14F);
const Color linen(0.25F, 0.36F, 0.42F);
const Color white(0.94F, 0.93F, 0.90F);
const Color dark(0.12F, 0.09F, 0.08F);

Vector3d mirrored(const Vector3d& p) {
  return {std::abs(p.x()), p.y(), p.z()};
}

/// Skull, cheeks, jaw, brows, with sockets for the eyes.
double face_distance(const Vector3d& p) {
  const Vector3d q = mirrored(p);
  double d = ellipsoid_distance(q, {0, 12, 190}, {70, 86, 66});
  d = blend(d, ellipsoid_distance(q, {0, -30, 160}, {54, 56, 70}), 18);
  d = blend(d, ellipsoid_distance(q, {30, -52, 148}, {22, 20, 17}), 16);
  d = blend(d, ellipsoid_distance(q, {0, -58, 103}, {24, 26, 17}), 22);
  d = blend(d, limb_distance(q, {7, -84, 186}, {40, -70, 187}, 6, 5), 10);
  return carve(d, ellipsoid_distance(q, {26, -92, 171}, {17, 16, 10}), 10);
}

double nose_distance(const Vector3d& p) {
  const Vector3d q = mirrored(p);
  double d = limb_distance(q, {0, -82, 180}, {0, -101, 147}, 5.5, 8.5);
  d = blend(d, ellipsoid_distance(q, {8.5, -92, 143}, {6.5, 9, 5.5}), 4);
  return carve(d, ellipsoid_distance(q, {5.5, -99, 137}, {2.6, 4.5, 3}), 1.5);
}

double ear_distance(const Vector3d& p) {
  const Vector3d q = mirrored(p);
  const double shell = ellipsoid_distance(q, {70, 0, 163}, {8, 18, 28});
  return carve(shell, ellipsoid_distance(q, {79, -4, 166}, {6, 9, 16}), 3);
}

Color face_paint(const Vector3d& p) {
  const double x = std::abs(p.x());
  if (p.y() < -50 && std::hypot((x - 26 - 0.1 * (p.z() - 190)) / 17, (p.z() - 189) / 3) < 1) return chestnut;
  const double blush = 1 - std::hypot(x - 34, p.z() - 142) / 20;
  return grained(mix(skin, rose, 0.45 * std::max(blush, 0.0)), p, 9, 0.18);
}

Color eye_paint(const Vector3d& p) {
  const double from_pupil = std::hypot(std::abs(p.x()) - 26, p.z() - 171.5);
  if (std::abs(p.z() - 171) > 5.8) return grained(skin, p, 9, 0.3);  // lids
  if (from_pupil < 2.4) return dark;
  return from_pupil < 5.6 ? linen : white;
}

/// Combed back from a parting at one side: waves on a cap above the hair line.
double hair_distance(const Vector3d& p) {
  const double along = p.y() + 0.35 * p.z();
  const double strand = 1.6 * std::sin(0.42 * (p.x() + 7 * std::sin(along / 30)));
  const double cap = ellipsoid_distance(p, {0, 17, 192}, {77, 90, 71}) - strand;
  const double hair_line = -(p - Vector3d(0, -60, 214)).dot(Vector3d(0, 0.62, 0.78));
  const double parting = limb_distance(p, {22, -58, 240}, {16, 30, 268}, 5, 5);
  return carve(carve(cap, -hair_line, 8), parting, 4);
}

Color hair_paint(const Vector3d& p) {
  const Vector3d q(p.x() / 2.4, (p.y() + p.z()) / 30, (p.y() - p.z()) / 30);
  return mix(chestnut, auburn, 1.6 * cloud_noise(q, 131) - 0.3);
}

void add_hair(std::vector<Part>& parts) {
  parts.push_back({hair_distance, 3, hair_paint});
  parts.push_back({[](const Vector3d& p) {
                     const double turn = std::atan2(p.z() - 226, p.x() - 18);
                     return ellipsoid_distance(p, {18, 104, 226}, {33, 24, 31}) -
                            1.5 * std::sin(5 * turn + 0.16 * (p.y() - 90));
                   },
                   4, hair_paint});
  const Tube plait({Vector4d(-56, 52, 168, 17), Vector4d(-72, 40, 128, 16), Vector4d(-70, 2, 84, 15),
                    Vector4d(-52, -42, 62, 13), Vector4d(-44, -52, 40, 9), Vector4d(-42, -55, 28, 5)});
  parts.push_back({[plait](const Vector3d& p) {
                     const Tube::Nearest near = plait.nearest(p);
                     return near.distance + 2.2 - 2.2 * std::abs(std::sin(34 * near.along));
                   },
                   3,
                   [plait](const Vector3d& p) {
                     return std::abs(plait.nearest(p).along - 0.83) < 0.02 ? rose : hair_paint(p);
                   }});
}

Color dress_paint(const Vector3d& p) {
  if (p.z() > 66 - 0.1 * p.y()) return white;
  return std::abs(std::remainder(p.x() + 0.5 * p.z(), 13)) < 1.1 ? white : grained(linen, p, 7, 0.4);
}

}  // namespace

ImplicitShape head_shape() {
  std::vector<Part> parts;
  parts.push_back(
      {cylinder(Axis::z, {0, 6, 8}, 60, 8, 2.5), 1, [](const Vector3d& p) {
         return mix(marble, linen, 1.2 * cloud_noise({p.x() / 30, p.y() / 9, p.z() / 18}, 133) - 0.4);
       }});
  parts.push_back({ellipsoid({0, 8, 40}, {96, 48, 34}), 6, dress_paint});
  parts.push_back({limb({0, 14, 50}, {0, 6, 120}, 40, 36), 14, face_paint});
  parts.push_back({face_distance, 9, face_paint});
  parts.push_back({nose_distance, 6, face_paint});
  parts.push_back({ear_distance, 3, face_paint});
  for (const double side : {-1.0, 1.0})
    parts.push_back({ellipsoid({26 * side, -68, 171}, {13, 11.5, 9.5}), 1, eye_paint});
  const Paint lips = plain(rose, 5, 0.2);
  parts.push_back({ellipsoid({0, -82.5, 122.5}, {18, 9, 4}), 2, lips});
  parts.push_back({ellipsoid({0, -80.5, 115}, {15, 9, 4.5}), 2.5, lips});
  add_hair(parts);
  ImplicitShape head =
      compose(std::move(parts), {{[](const Vector3d& p) { return p.z(); }, 0.5, plain(marble)}},
              BoundingBox(Vector3d(-100, -112, -1), Vector3d(100, 134, 272)));
  head.pitch = 2;
  head.deviation = 0.1;
  return head;
}

}  // namespace drape::simulation
