// A figure in a long coat and a hat, one arm raised, a coil of rope in the other hand, on a stepped base. As
// with a cast that leans against a wall, its back is open and it is hollow.
#include <Eigen/Geometry>
#include <numbers>

#include "solids.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using std::numbers::pi;

const Color stone(0.66F, 0.63F, 0.58F);
const Color bronze(0.42F, 0.30F, 0.17F);
const Color verdigris(0.38F, 0.52F, 0.43F);
const Color skin(0.80F, 0.58F, 0.43F);
const Color felt(0.36F, 0.22F, 0.12F);
const Color scarlet(0.72F, 0.13F, 0.10F);
const Color denim(0.20F, 0.28F, 0.45F);
const Color leather(0.22F, 0.12F, 0.07F);
const Color hemp(0.80F, 0.68F, 0.44F);
const Color brass(0.86F, 0.68F, 0.25F);

Color granite(const Vector3d& p) {
  if (in_speckle(p, 2.6, 0.45, 51)) return {0.30F, 0.29F, 0.28F};
  if (in_speckle(p, 3.7, 0.3, 61)) return {0.85F, 0.82F, 0.76F};
  return grained(stone, p, 9, 0.5);
}

/// Bronze, green where rain runs and stands.
Color coat_paint(const Vector3d& p) {
  if (p.y() < -8 && std::abs(p.x() - 2) < 40) {
    for (int i = 0; i < 5; ++i)  // buttons down the front
      if (std::hypot(p.x() - 5.5, p.z() - (128 + 18 * i)) < 2.6) return brass;
    if (std::abs(p.x() - 1) < 0.8 && p.z() < 222) return leather;  // the edge of the upper front
  }
  if (std::abs(p.z() - 166) < 5) {  // a belt
    const bool buckle = p.y() < 0 && std::abs(p.x() - 1) < 7;
    return buckle && (std::abs(p.x() - 1) > 4.6 || std::abs(p.z() - 166) > 2.9) ? brass
                                                                                : grained(leather, p, 6, 0.5);
  }
  if (p.z() < 82) return grained(brass, p, 8, 0.5);  // the hem
  const Vector3d streaks(p.x() / 7, p.y() / 7, p.z() / 45);
  return mix(grained(bronze, p, 12, 0.5), verdigris, ease((cloud_noise(streaks, 71) - 0.44) / 0.26));
}

Color sleeve_paint(const Vector3d& p) {
  const Vector3d streaks(p.x() / 9, p.y() / 9, p.z() / 25);
  return mix(grained(bronze, p, 12, 0.5), verdigris, ease((cloud_noise(streaks, 81) - 0.44) / 0.26));
}

Color scarf_paint(const Vector3d& p) {
  const Vector3d q = p / 6.5;
  const Vector3d center(std::round(q.x()), std::round(q.y()), std::round(q.z()));
  return (q - center).norm() < 0.3 ? Color(0.95F, 0.88F, 0.75F) : scarlet;
}

void add_base(std::vector<Part>& parts) {
  parts.push_back({box({0, 0, 9}, {64, 47, 9}, 2.5), 1, granite});
  parts.push_back({box({0, 0, 25}, {56, 40, 15}, 2.5), 2, granite});
  // A name plate on the front, with two lines of raised "letters" painted on.
  parts.push_back({box({0, -40, 28}, {30, 2.2, 7.5}, 1.2), 0.5, [](const Vector3d& p) -> Color {
                     if (std::abs(p.x()) > 28 || std::abs(p.z() - 28) > 6) return brass;
                     const double line = std::abs(std::abs(p.z() - 28) - 2.6);
                     const double stroke = value_noise({p.x() / 1.6, p.z() > 28 ? 0.5 : 7.5, 0.5}, 91);
                     return line < 1.5 && stroke > 0.42 ? leather : Color(0.62F, 0.46F, 0.16F);
                   }});
  parts.push_back({ellipsoid({35, -14, 44}, {19, 21, 18}), 3, [](const Vector3d& p) {
                     return grained({0.45F, 0.43F, 0.42F}, p, 7, 0.8);
                   }});
}

/// The coat's own body: a bell that is flatter than wide. `p` in the object's frame.
double coat_distance(const Revolution& bell, const Vector3d& p) {
  constexpr double flatter = 1.3;
  // Folds: the hem waves.
  const double around = std::atan2(flatter * p.y(), p.x());
  const double fold = 2.6 * std::cos(9 * around) * ease((150 - p.z()) / 70);
  return 0.8 * (bell.distance({p.x(), flatter * p.y(), p.z()}) - fold);
}

Revolution coat_bell() {
  return Revolution({Vector2d(0, 62), Vector2d(36, 62), Vector2d(43, 63), Vector2d(44.5, 66),
                     Vector2d(43, 74), Vector2d(37, 110), Vector2d(33, 145), Vector2d(29.5, 168),
                     Vector2d(33, 195), Vector2d(38, 218), Vector2d(37, 230), Vector2d(28, 239),
                     Vector2d(14, 245), Vector2d(0, 247)});
}

void add_legs(std::vector<Part>& parts) {
  parts.push_back({limb({-17, 0, 120}, {-18, -2, 46}, 15, 9.5), 3, plain(denim)});
  parts.push_back({limb({-19, -2, 44}, {-21, -22, 44}, 9, 7), 3, plain(leather)});
  parts.push_back({limb({-19, -2, 44}, {-19, -1, 66}, 10.5, 11.5), 1, plain(leather)});
  // The other leg stands on the boulder, the knee pushing the coat out.
  parts.push_back({limb({14, -4, 150}, {27, -28, 112}, 14, 13), 9, coat_paint});
  parts.push_back({limb({27, -27, 108}, {32, -19, 70}, 11, 9), 3, plain(denim)});
  parts.push_back({limb({32, -19, 67}, {36, -39, 64}, 9, 7), 3, plain(leather)});
  parts.push_back({limb({32, -19, 68}, {30.5, -21, 84}, 10, 10.8), 1, plain(leather)});
}

void add_arms(std::vector<Part>& parts) {
  // Raised, waving.
  parts.push_back({limb({-30, 0, 231}, {-65, -7, 246}, 13.5, 11), 6, sleeve_paint});
  parts.push_back({limb({-65, -7, 246}, {-77, -15, 286}, 11, 8.6), 3, sleeve_paint});
  parts.push_back({limb({-76.6, -14.8, 284}, {-77.6, -15.3, 288}, 9.6, 9.6), 0.8, plain(brass)});
  parts.push_back({ellipsoid({-80, -17, 302}, {8.5, 4.8, 10.5}), 2.5, plain(skin)});
  parts.push_back({limb({-85, -17, 307}, {-92, -18, 319}, 2.7, 2.3), 1.5, plain(skin)});
  parts.push_back({limb({-82, -18, 309}, {-85, -19, 325}, 2.8, 2.4), 1.5, plain(skin)});
  parts.push_back({limb({-78, -18, 310}, {-78, -19, 326}, 2.8, 2.4), 1.5, plain(skin)});
  parts.push_back({limb({-74.5, -17.5, 308}, {-71.5, -18, 321}, 2.6, 2.2), 1.5, plain(skin)});
  parts.push_back({limb({-73, -17, 298}, {-64, -19, 305}, 3.2, 2.5), 2, plain(skin)});
  // Bent, with the rope.
  parts.push_back({limb({30, 0, 229}, {57, 2, 192}, 13.5, 11), 6, sleeve_paint});
  parts.push_back({limb({57, 2, 192}, {49, -28, 172}, 11, 8.6), 3, sleeve_paint});
  parts.push_back({limb({49.4, -26.6, 173}, {48.8, -29.4, 171}, 9.6, 9.6), 0.8, plain(brass)});
  parts.push_back({ellipsoid({46, -37, 166}, {8, 9, 8.5}), 2.5, plain(skin)});
  for (int coil = 0; coil < 3; ++coil) {
    const Vector3d center(50.0 + 3.2 * coil, -40.0 + 2.2 * coil, 145.0 - 1.5 * coil);
    const Vector3d axis = Vector3d(0.75 - 0.12 * coil, -0.62, 0.1).normalized();
    parts.push_back({[=](const Vector3d& p) { return torus_distance(p, center, axis, 20.0 + coil, 2.5); },
                     1.2,
                     [=](const Vector3d& p) {
                       const double turn = p.x() + p.y() + 1.4 * p.z();
                       return std::fmod(std::abs(turn), 3.2) < 0.9 ? Color(0.50F, 0.38F, 0.20F) : hemp;
                     }});
  }
}

/// Into coordinates of the head: turned towards its left hand and tilted.
Vector3d in_head_frame(const Vector3d& p) {
  static const Eigen::Matrix3d head_from_object =
      (Eigen::AngleAxisd(0.36, Vector3d::UnitZ()) * Eigen::AngleAxisd(-0.08, Vector3d::UnitY()))
          .toRotationMatrix()
          .transpose();
  return head_from_object * (p - Vector3d(0, -6, 273));
}

Color face_paint(const Vector3d& p) {
  const Vector3d q = in_head_frame(p);
  if (q.y() > 5 || (std::abs(q.x()) > 12.8 && q.y() > -3.5))
    return grained(leather, {p.x(), p.y(), p.z() / 4}, 2, 0.6);
  if (q.y() < -8) {
    const double eye = std::hypot((std::abs(q.x()) - 5.8) / 2.9, (q.z() - 2.2) / 1.6);
    if (eye < 1)
      return std::hypot(std::abs(q.x()) - 5.8, q.z() - 2.2) < 1.4 ? leather : Color(0.93F, 0.91F, 0.87F);
    if (std::abs(std::abs(q.x()) - 6) < 3.6 && std::abs(q.z() - 5.4) < 0.8) return leather;
    if (std::hypot(q.x() / 5, (q.z() + 9.5) / 1.3) < 1) return {0.62F, 0.25F, 0.22F};
    if (std::hypot(std::abs(q.x()) - 8.5, q.z() + 4) < 3.5) return mix(skin, scarlet, 0.25);
  }
  return grained(skin, p, 6, 0.2);
}

double hat_brim(const Vector3d& p) {
  Vector3d q = in_head_frame(p) - Vector3d(0, 1, 11);
  q.z() -= 0.0125 * q.x() * q.x() - 0.004 * q.y() * q.y();  // curled up at the sides, down before and behind
  const Vector3d wide(q.x(), 0.86 * q.y(), q.z());
  return 0.75 * cylinder_distance(wide, Vector3d::Zero(), 31, 2.2, 2);
}

double hat_crown(const Vector3d& p) {
  const Vector3d q = in_head_frame(p) - Vector3d(0, 1, 11);
  const double crown = limb_distance(q, {0, 0, 2}, {0, 1, 15}, 17.5, 14.5);
  const double crease = ellipsoid_distance(q, {0, 2, 32}, {5.5, 20, 6.5});
  return carve(crown, crease, 5);
}

Color hat_paint(const Vector3d& p) {
  const double height = in_head_frame(p).z() - 11;
  const double side = in_head_frame(p).head<2>().norm();
  if (side < 20.5 && height > 2.4 && height < 7.5) return height < 3.3 || height > 6.6 ? brass : scarlet;
  return grained(felt, p, 5, 0.45);
}

void add_head(std::vector<Part>& parts) {
  const auto in_head = [](Distance distance) -> Distance {
    return [distance = std::move(distance)](const Vector3d& p) { return distance(in_head_frame(p)); };
  };
  parts.push_back({limb({0, -2, 240}, {0, -4, 260}, 11, 10), 4, plain(skin)});
  parts.push_back({in_head(ellipsoid({0, 0, 2}, {14.8, 17, 18})), 3, face_paint});
  parts.push_back({in_head(ellipsoid({0, -8, -11}, {8.5, 8, 6.5})), 6, face_paint});
  parts.push_back({in_head(limb({0, -15.5, 3}, {0, -19.5, -3}, 1.9, 2.8)), 3, face_paint});
  for (const double side : {-1.0, 1.0}) {
    parts.push_back({in_head(ellipsoid({14.8 * side, 1, 0}, {2.4, 3.6, 5})), 1.5, face_paint});
    parts.push_back({in_head(limb({2 * side, -15.4, 6}, {9 * side, -12.4, 5.2}, 1.7, 1.5)), 3, face_paint});
  }
  parts.push_back({hat_brim, 1, hat_paint});
  parts.push_back({hat_crown, 2, hat_paint});
  // A neckerchief, knotted in front.
  parts.push_back({[](const Vector3d& p) {
                     return torus_distance(p, {0, -3, 248}, Vector3d(0, -0.3, 0.954), 12, 5);
                   },
                   1.5, scarf_paint});
  parts.push_back({limb({-1, -17, 243}, {-7, -31, 227}, 4.2, 3.6), 1.5, scarf_paint});
  parts.push_back({limb({1, -17, 243}, {6, -31, 230}, 4.2, 3.6), 1.5, scarf_paint});
}

std::vector<Part> hollows(const Revolution& bell) {
  constexpr double wall = 6;
  const Paint cavity = [](const Vector3d& p) { return grained({0.34F, 0.29F, 0.25F}, p, 10, 0.6); };
  // Everything behind the wall of the front half, down to a floor that the legs stand in.
  const Distance behind_coat = [bell](const Vector3d& p) {
    return std::max(coat_distance(bell, {p.x(), std::min(p.y(), 0.0), p.z()}) + wall, 84 - p.z());
  };
  const Distance behind_base = [](const Vector3d& p) {
    return box_distance({p.x(), std::min(p.y(), 0.0), p.z()}, {0, 0, 15}, {46, 31, 15}, 3);
  };
  return {{behind_coat, 2, cavity}, {behind_base, 2, cavity}};
}

}  // namespace

ImplicitShape statue_shape() {
  const Revolution bell = coat_bell();
  std::vector<Part> parts;
  add_base(parts);
  parts.push_back({[bell](const Vector3d& p) { return coat_distance(bell, p); }, 2, coat_paint});
  add_legs(parts);
  add_arms(parts);
  add_head(parts);
  ImplicitShape statue =
      compose(std::move(parts), hollows(bell), BoundingBox(Vector3d(-98, -66, -1), Vector3d(86, 50, 335)));
  statue.pitch = 1.3;
  statue.deviation = 0.07;
  return statue;
}

}  // namespace drape::simulation
