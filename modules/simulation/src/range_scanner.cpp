#include "drape/simulation/range_scanner.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>

#include "drape/base/parallel.hpp"
#include "drape/base/random.hpp"

namespace drape::simulation {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

struct LatticeRay {
  Vector3d origin;     // in the scanner's frame
  Vector3d direction;  // unit length
};

LatticeRay lattice_ray(const ScannerSpec& spec, int row, int column) {
  const double across = column - (spec.columns - 1) / 2.0;
  const double down = row - (spec.rows - 1) / 2.0;
  if (spec.rays == Rays::parallel)
    return {Vector3d(across * spec.pitch_m, down * spec.pitch_m, 0), Vector3d::UnitZ()};
  const double azimuth = across * spec.pitch_deg * pi / 180;
  const double elevation = down * spec.pitch_deg * pi / 180;
  return {Vector3d::Zero(), Vector3d(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                                     std::cos(azimuth) * std::cos(elevation))};
}

/// What the ray of a lattice cell meets. Range 0: nothing.
struct Echo {
  double range = 0;
  double cosine = 0;  // of the incidence; negative on the inner side of a face
  std::uint32_t face = 0;
  Vector3d weights = Vector3d::Zero();
};

std::vector<Echo> echoes(const TriangleMesh& mesh, const RayCaster& caster, const Rigid3& world_from_scanner,
                         const ScannerSpec& spec) {
  std::vector<Echo> result(static_cast<std::size_t>(spec.rows) * static_cast<std::size_t>(spec.columns));
  parallel_for(static_cast<std::size_t>(spec.rows), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int column = 0; column < spec.columns; ++column) {
        const LatticeRay ray = lattice_ray(spec, static_cast<int>(row), column);
        const Vector3d direction = world_from_scanner.linear() * ray.direction;
        const auto hit = caster.first_hit(world_from_scanner * ray.origin, direction);
        if (!hit) continue;
        const Vector3d normal = scaled_face_normal(mesh, hit->face).normalized();
        result[row * static_cast<std::size_t>(spec.columns) + static_cast<std::size_t>(column)] = {
            hit->distance, -normal.dot(direction), hit->face, hit->weights};
      }
  });
  return result;
}

/// The range that cell `index`'s beam would also meet: a neighbour's that no surface within the incidence
/// limit can join to its own. The nearest row and column first.
std::optional<double> range_across_edge(const std::vector<Echo>& lattice, int row, int column,
                                        const ScannerSpec& spec) {
  const auto at = [&](int r, int c) -> const Echo& {
    return lattice[static_cast<std::size_t>(r) * static_cast<std::size_t>(spec.columns) +
                   static_cast<std::size_t>(c)];
  };
  const double range = at(row, column).range;
  const double pitch = spec.rays == Rays::parallel ? spec.pitch_m : range * spec.pitch_deg * pi / 180;
  const double steepest = 1.5 * pitch * std::tan(spec.max_incidence_deg * pi / 180) + pitch;
  static constexpr int steps[4][2] = {{-1, 0}, {0, -1}, {0, 1}, {1, 0}};
  for (const auto& step : steps) {
    const int r = row + step[0];
    const int c = column + step[1];
    if (r < 0 || c < 0 || r >= spec.rows || c >= spec.columns) continue;
    const double other = at(r, c).range;
    if (other > 0 && std::abs(other - range) > steepest) return other;
  }
  return std::nullopt;
}

/// The measured range, or nothing.
std::optional<double> measure(const std::vector<Echo>& lattice, int row, int column,
                              const ScannerSpec& spec) {
  const std::size_t index = static_cast<std::size_t>(row) * static_cast<std::size_t>(spec.columns) +
                            static_cast<std::size_t>(column);
  const Echo& echo = lattice[index];
  if (echo.range <= 0) return std::nullopt;
  Rng random(item_seed(spec.seed, index));
  // Drawn whatever becomes of them, so that one option does not change what another one draws.
  const double noise = random.normal();
  const double mixed = random.uniform();
  const double share = random.uniform();
  const double cosine = echo.cosine;
  if (100 * mixed < spec.mixed_pixel_percent)
    if (const auto other = range_across_edge(lattice, row, column, spec))
      return echo.range + share * (*other - echo.range);
  if (cosine <= 0 || cosine < std::cos(spec.max_incidence_deg * pi / 180)) return std::nullopt;
  return echo.range + noise * spec.noise_m / cosine;
}

void add_attributes(PointCloud& cloud, const TriangleMesh& mesh, const Echo& echo, const ScannerSpec& spec) {
  if (!spec.intensity && !spec.color) return;
  Eigen::Vector3f color = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    color += static_cast<float>(echo.weights[static_cast<Eigen::Index>(k)]) *
             mesh.colors[mesh.faces[echo.face][k]];
  color = color.cwiseMax(0.0F).cwiseMin(1.0F);
  if (spec.color) cloud.colors.push_back(color);
  if (spec.intensity)
    cloud.intensities.push_back(color.mean() * static_cast<float>(std::clamp(echo.cosine, 0.0, 1.0)));
}

}  // namespace

RangeScan scan(const TriangleMesh& mesh, const RayCaster& caster, const Rigid3& world_from_scanner,
               const ScannerSpec& spec) {
  assert(spec.rows > 0 && spec.columns > 0);
  assert((!spec.intensity && !spec.color) || mesh.colors.size() == mesh.vertices.size());
  const std::vector<Echo> lattice = echoes(mesh, caster, world_from_scanner, spec);
  RangeScan result;
  result.grid =
      RangeGrid{spec.rows, spec.columns, std::vector<std::int32_t>(lattice.size(), RangeGrid::missing)};
  result.view = spec.rays == Rays::parallel ? ScanView{ScanView::Kind::direction, Vector3d::UnitZ()}
                                            : ScanView{ScanView::Kind::origin, Vector3d::Zero()};
  result.world_from_scan = world_from_scanner;
  for (int row = 0; row < spec.rows; ++row)
    for (int column = 0; column < spec.columns; ++column) {
      const auto range = measure(lattice, row, column, spec);
      if (!range) continue;
      const std::size_t index = static_cast<std::size_t>(row) * static_cast<std::size_t>(spec.columns) +
                                static_cast<std::size_t>(column);
      const LatticeRay ray = lattice_ray(spec, row, column);
      result.grid->cells[index] = static_cast<std::int32_t>(result.cloud.size());
      result.cloud.positions.push_back(ray.origin + *range * ray.direction);
      add_attributes(result.cloud, mesh, lattice[index], spec);
    }
  return result;
}

RangeScan scan(const TriangleMesh& mesh, const Rigid3& world_from_scanner, const ScannerSpec& spec) {
  return scan(mesh, RayCaster(mesh), world_from_scanner, spec);
}

}  // namespace drape::simulation
