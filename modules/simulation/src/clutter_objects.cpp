// What stands about in photos: in warm colours, so that a photo's object can be told from them by colour.
#include <numbers>

#include "distance_functions.hpp"
#include "implicit_shape.hpp"
#include "paint.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

}  // namespace

ImplicitShape mug_shape() {
  const Distance wall = [](const Vector3d& p) { return cylinder_distance(p, {0, 0, 44}, 38.5, 44, 4); };
  const Tube handle({Vector4d(34, 0, 70, 6), Vector4d(58, 0, 71, 5), Vector4d(65, 0, 46, 5),
                     Vector4d(54, 0, 24, 5), Vector4d(35, 0, 20, 6)});
  const Distance inside = [](const Vector3d& p) { return cylinder_distance(p, {0, 0, 58}, 33, 50, 3); };
  const Paint terracotta = [](const Vector3d& p) -> Color {
    if (p.z() > 62 + 4 * cloud_noise(p / 12, 101)) return {0.93F, 0.87F, 0.74F};
    return mix({0.70F, 0.36F, 0.20F}, {0.48F, 0.22F, 0.12F}, cloud_noise(p / 8, 102));
  };
  ImplicitShape mug =
      compose({{wall, 1, terracotta},
               {[handle](const Vector3d& p) { return handle.nearest(p).distance; }, 4, terracotta}},
              {{inside, 2.5, terracotta}}, BoundingBox(Vector3d(-42, -42, -1), Vector3d(74, 42, 92)));
  mug.pitch = 1.4;
  mug.deviation = 0.06;
  return mug;
}

ImplicitShape apple_shape() {
  const Revolution body({Vector2d(0, 7), Vector2d(8, 1.5), Vector2d(16, 0), Vector2d(31, 14),
                         Vector2d(38, 38), Vector2d(32, 60), Vector2d(18, 68), Vector2d(6, 63),
                         Vector2d(0, 58)});
  const Paint peel = [](const Vector3d& p) {
    const double blush =
        ease(0.5 + 0.9 * (cloud_noise({p.x() / 18, p.y() / 18, p.z() / 40}, 111) - 0.5) + p.x() / 80);
    const Color color = mix({0.86F, 0.66F, 0.22F}, {0.70F, 0.10F, 0.08F}, blush);
    return in_speckle(p, 4, 0.5, 112) ? mix(color, {0.95F, 0.85F, 0.6F}, 0.6) : color;
  };
  ImplicitShape apple = compose({{[body](const Vector3d& p) { return body.distance(p); }, 1, peel},
                                 {[](const Vector3d& p) {
                                    return limb_distance(p, {0, 0, 55}, {5, 2, 80}, 1.8, 2.2);
                                  },
                                  1, [](const Vector3d&) { return Color(0.30F, 0.20F, 0.10F); }}},
                                {}, BoundingBox(Vector3d(-42, -42, -1), Vector3d(42, 42, 86)));
  apple.pitch = 2.5;
  apple.deviation = 0.1;
  return apple;
}

ImplicitShape books_shape() {
  // Two books, one across the other.
  const auto book = [](double bottom, double thickness, double turn, double length, const Color& cover) {
    const Eigen::Vector2d along(std::cos(turn), std::sin(turn));
    const auto local = [=](const Vector3d& p) {
      return Vector3d(along.dot(p.head<2>()), along.x() * p.y() - along.y() * p.x(), p.z() - bottom);
    };
    const double half = thickness / 2;
    const Distance boards = [=](const Vector3d& p) {
      const Vector3d q = local(p);
      const double block = box_distance(q, {0, 0, half}, {length / 2, 52, half}, 2);
      const double pages = box_distance(q, {0, 12, half}, {length, 60, half - 3}, 0.5);
      return std::max(block, -pages);
    };
    const Distance pages = [=](const Vector3d& p) {
      return box_distance(local(p), {0, -1, half}, {length / 2 - 4, 48, half - 2.5}, 1);
    };
    const Paint cloth = [=](const Vector3d& p) {
      const Vector3d q = local(p);
      if (std::abs(std::abs(q.x()) - 0.36 * length) < 2.5 && q.y() < -48) return Color(0.85F, 0.68F, 0.3F);
      return mix(cover, Color::Zero(), 0.35 * cloud_noise(p / 3, 121));
    };
    const Paint paper = [=](const Vector3d& p) {
      return mix({0.90F, 0.84F, 0.70F}, {0.62F, 0.54F, 0.40F},
                 0.6 * value_noise({0.5, 0.5, p.z() / 0.7}, 122));
    };
    return std::vector<Part>{{boards, 0.5, cloth}, {pages, 0.5, paper}};
  };
  std::vector<Part> parts = book(0, 32, 0, 190, {0.45F, 0.12F, 0.10F});
  for (Part& part : book(31.5, 26, 0.35, 160, {0.52F, 0.40F, 0.14F})) parts.push_back(std::move(part));
  ImplicitShape books =
      compose(std::move(parts), {}, BoundingBox(Vector3d(-110, -90, -1), Vector3d(110, 90, 60)));
  books.pitch = 1.2;
  books.deviation = 0.1;
  return books;
}

}  // namespace drape::simulation
