// Table and wall.
#include <cmath>
#include <numbers>

#include "paint.hpp"
#include "scene.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Color wooden_planks(const Vector2d& at) {
  // Planks run a little askew.
  const double along = 0.96 * at.x() + 0.28 * at.y();
  const double across = 0.96 * at.y() - 0.28 * at.x();
  constexpr double width = 0.085;
  const double number = std::floor(across / width);
  const auto plank = static_cast<int>(number);
  const double within = across / width - number;
  if (within < 0.02) return {0.20F, 0.12F, 0.06F};
  const double shade = cell_random({plank, 0, 0}, 201);
  const Vector3d fibre(along / 0.11 + 40 * shade, across / 0.006, plank);
  const double rings = cloud_noise({along / 0.25, across / 0.03, 7.0 * plank}, 202);
  const double grain = 0.5 + 0.5 * std::sin(2 * std::numbers::pi * (9 * rings + across / 0.02));
  Color wood = mix({0.62F, 0.41F, 0.22F}, {0.50F, 0.31F, 0.15F}, shade);
  wood = mix(wood, {0.38F, 0.22F, 0.10F}, 0.35 * grain);
  return mix(wood, {0.70F, 0.50F, 0.29F}, 0.5 * (cloud_noise(fibre, 203) - 0.3));
}

Color woven_cloth(const Vector2d& at) {
  const Vector2d turned(0.94 * at.x() - 0.34 * at.y(), 0.94 * at.y() + 0.34 * at.x());
  constexpr double period = 0.05;
  const double weave = 0.5 + 0.25 * (std::sin(turned.x() / 0.00035) + std::sin(turned.y() / 0.00035));
  const auto striped = [&](double t) { return t / period - std::floor(t / period) < 0.3 ? 1 : 0; };
  const int stripes = striped(turned.x()) + striped(turned.y());
  const Color ground =
      mix({0.88F, 0.86F, 0.80F}, {0.78F, 0.76F, 0.70F}, cloud_noise({at.x() / 0.06, at.y() / 0.06, 0}, 211));
  return mix(mix(ground, {0.30F, 0.42F, 0.62F}, 0.45 * stripes), Color::Zero(), 0.12 * weave);
}

}  // namespace

Color table_paint(Table table, const Vector2d& position) {
  return table == Table::wood ? wooden_planks(position) : woven_cloth(position);
}

Color wall_paint(Table table, const Vector2d& position) {
  const double plaster = cloud_noise({position.x() / 0.05, position.y() / 0.05, 0.5}, 221);
  if (table == Table::cloth) return mix({0.70F, 0.74F, 0.76F}, {0.56F, 0.61F, 0.64F}, 1.6 * (plaster - 0.3));
  // Wallpaper: stripes with a row of lozenges in every other one.
  constexpr double width = 0.07;
  const double stripe = position.x() / width;
  const bool wide = static_cast<long>(std::floor(stripe)) % 2 == 0;
  const double across = std::abs(stripe - std::floor(stripe) - 0.5);
  const double down = std::abs(position.y() / 0.09 - std::floor(position.y() / 0.09) - 0.5);
  Color paper = wide ? Color(0.86F, 0.76F, 0.58F) : Color(0.80F, 0.68F, 0.49F);
  if (wide && across + 0.8 * down < 0.26)
    paper = across + 0.8 * down < 0.14 ? Color(0.72F, 0.47F, 0.30F) : Color(0.78F, 0.61F, 0.40F);
  if (across > 0.47) paper = {0.70F, 0.56F, 0.38F};
  return mix(paper, {0.66F, 0.55F, 0.40F}, 0.7 * (plaster - 0.3));
}

}  // namespace drape::simulation
