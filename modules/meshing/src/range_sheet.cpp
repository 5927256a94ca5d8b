#include "range_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "drape/base/random.hpp"
#include "planar_delaunay.hpp"
#include "range_denoising.hpp"
#include "sample_neighbors.hpp"

namespace drape::meshing {
namespace {

constexpr float unseen = std::numeric_limits<float>::quiet_NaN();

std::vector<RangeSample> samples_of(const RangeScan& scan, const Rigid3& world_from_scan, Sight& sight) {
  const auto count = scan.cloud.size();
  std::vector<Eigen::Vector3d> pictures(count);
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& p = scan.cloud.positions[i];
    if (!p.allFinite()) continue;
    pictures[i] = sight.picture_of(world_from_scan * p);
  }
  std::vector<RangeSample> samples(count);
  const double widest =
      sight.parallel ? std::numeric_limits<double>::infinity() : sight.widest_tangent / sight.pitch;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& p = pictures[i];
    const bool in_view = scan.cloud.positions[i].allFinite() && (sight.parallel || p.z() > 0) &&
                         p.head<2>().cwiseAbs().maxCoeff() <= widest;
    if (in_view) least = least.cwiseMin(p.head<2>());
    samples[i].depth = in_view ? static_cast<float>(p.z()) : unseen;
  }
  if (!least.allFinite()) return samples;
  least.array() = least.array().floor() - 3;
  for (std::size_t i = 0; i < count; ++i) {
    samples[i].column = static_cast<float>(pictures[i].x() - least.x());
    samples[i].row = static_cast<float>(pictures[i].y() - least.y());
  }
  sight.corner = least * sight.pitch;
  return samples;
}

// Decides where the surface ends.
class SurfaceTest {
 public:
  SurfaceTest(const RangeSheet& sheet, const SheetLimits& limits)
      : sheet_(sheet),
        longest_edge_(static_cast<float>(limits.longest_edge_spacings)),
        least_cosine_(static_cast<float>(std::cos(limits.max_incidence_deg * std::numbers::pi / 180))) {}

  [[nodiscard]] bool is_surface(const Face& f) const {
    const RangeSample& a = sheet_.samples[f[0]];
    const RangeSample& b = sheet_.samples[f[1]];
    const RangeSample& c = sheet_.samples[f[2]];
    if (!seen(a) || !seen(b) || !seen(c)) return false;
    const Eigen::Vector3f ab = step(a, b);
    const Eigen::Vector3f ac = step(a, c);
    const float most = longest_edge_ * longest_edge_;
    if (ab.squaredNorm() > most || ac.squaredNorm() > most || (ac - ab).squaredNorm() > most) return false;
    const float area = ab.x() * ac.y() - ab.y() * ac.x();
    if (area == 0) return false;
    const float slope_x = (ab.z() * ac.y() - ac.z() * ab.y()) / area;
    const float slope_y = (ac.z() * ab.x() - ab.z() * ac.x()) / area;
    return sheet_.sight.incidence_cosine(a.column, a.row, slope_x, slope_y) >= least_cosine_;
  }

  /// In spacings: across, down, deep.
  [[nodiscard]] Eigen::Vector3f step(const RangeSample& from, const RangeSample& to) const {
    const auto per_pixel = static_cast<float>(1 / sheet_.sight.pixels_per_spacing);
    const auto per_length = static_cast<float>(1 / sheet_.sight.spacing_at(static_cast<double>(from.depth)));
    return {(to.column - from.column) * per_pixel, (to.row - from.row) * per_pixel,
            (to.depth - from.depth) * per_length};
  }

 private:
  const RangeSheet& sheet_;
  float longest_edge_;
  float least_cosine_;
};

// Each lattice square as two triangles along its shorter diagonal, or as the one that is there.
std::vector<Face> lattice_faces(const RangeGrid& grid, const RangeSheet& sheet, const SurfaceTest& test) {
  std::vector<Face> faces;
  faces.reserve(2 * sheet.samples.size());
  const auto keep = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
    if (a < 0 || b < 0 || c < 0) return;
    const Face face{static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                    static_cast<std::uint32_t>(c)};
    if (test.is_surface(face)) faces.push_back(face);
  };
  for (int row = 0; row + 1 < grid.rows; ++row)
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const std::int32_t a = grid.at(row, column);
      const std::int32_t b = grid.at(row, column + 1);
      const std::int32_t c = grid.at(row + 1, column + 1);
      const std::int32_t d = grid.at(row + 1, column);
      if ((a < 0) + (b < 0) + (c < 0) + (d < 0) > 1) continue;
      const auto length = [&](std::int32_t from, std::int32_t to) {
        return from < 0 || to < 0 ? std::numeric_limits<float>::infinity()
                                  : test.step(sheet.samples[static_cast<std::size_t>(from)],
                                              sheet.samples[static_cast<std::size_t>(to)])
                                        .squaredNorm();
      };
      if (length(a, c) <= length(b, d)) {
        keep(a, b, c);
        keep(a, c, d);
      } else {
        keep(a, b, d);
        keep(b, c, d);
      }
    }
  return faces;
}

// Rows of faces between each sample and the border, up to `most`: 0 on it. A fan of faces is closed if the
// steps from one of its outer vertices to the next add up to nothing.
std::vector<std::uint8_t> border_distances(const RangeSheet& sheet, int most) {
  std::vector<std::uint64_t> around(sheet.samples.size(), 0);
  for (const Face& f : sheet.faces)
    for (std::size_t k = 0; k < 3; ++k)
      around[f[k]] += item_seed(0, f[(k + 2) % 3]) - item_seed(0, f[(k + 1) % 3]);
  std::vector<std::uint8_t> distances(around.size());
  for (std::size_t i = 0; i < around.size(); ++i)
    distances[i] = around[i] == 0 ? static_cast<std::uint8_t>(most) : 0;
  for (int d = 1; d < most; ++d)
    for (const Face& f : sheet.faces) {
      const int least = std::min({distances[f[0]], distances[f[1]], distances[f[2]]});
      if (least != d - 1) continue;
      for (const std::uint32_t v : f)
        distances[v] = static_cast<std::uint8_t>(std::min<int>(distances[v], d));
    }
  return distances;
}

void weigh(RangeSheet& sheet) {
  constexpr int ramp = 4;
  const std::vector<std::uint8_t> distances = border_distances(sheet, ramp);
  for (const Face& f : sheet.faces)
    for (const std::uint32_t v : f) {
      RangeSample& s = sheet.samples[v];
      const float inside = (static_cast<float>(distances[v]) + 0.5F) / (ramp + 0.5F);
      // The root: with less weight than that, more of the other scans' noise comes in than of the border's
      // error stays out.
      s.weight = std::sqrt(inside) * sheet.sight.incidence_cosine(s.column, s.row, s.slope_x, s.slope_y);
    }
}

std::vector<Face> projected_faces(const RangeSheet& sheet, const SurfaceTest& test) {
  std::vector<PlanarSite> sites;
  for (std::uint32_t i = 0; i < sheet.samples.size(); ++i)
    if (const RangeSample& s = sheet.samples[i]; seen(s))
      sites.push_back({static_cast<double>(s.column), static_cast<double>(s.row), i});
  std::vector<Face> faces = delaunay_faces(sites);
  faces.erase(std::remove_if(faces.begin(), faces.end(), [&](const Face& f) { return !test.is_surface(f); }),
              faces.end());
  return faces;
}

}  // namespace

RangeSheet range_sheet(const RangeScan& scan, const Rigid3& world_from_scan, const Sight& sight,
                       const SheetLimits& limits) {
  RangeSheet sheet{sight, {}, {}, 0};
  sheet.samples = samples_of(scan, world_from_scan, sheet.sight);
  const SurfaceTest test(sheet, limits);
  const auto denoise = [&](const SampleNeighbors& neighbors) {
    Denoised result = denoised(sheet.samples, neighbors, sheet.sight, limits.longest_edge_spacings);
    sheet.samples = std::move(result.samples);
    sheet.noise_spacings = static_cast<double>(result.noise);
  };
  if (scan.grid) {
    denoise(SampleNeighbors(*scan.grid));
    sheet.faces = lattice_faces(*scan.grid, sheet, test);
  } else {
    sheet.faces = projected_faces(sheet, test);
    denoise(SampleNeighbors(sheet.faces, sheet.samples.size()));
  }
  weigh(sheet);
  return sheet;
}

}  // namespace drape::meshing
