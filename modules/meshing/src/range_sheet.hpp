// One scan as a triangulated height field over its sight.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "sight.hpp"

namespace drape::meshing {

struct RangeSample {
  float column = 0;
  float row = 0;
  float depth = 0;
  float slope_x = 0;  // of the depth, see Sight::normal_of
  float slope_y = 0;
  float weight = 0;  // cos(incidence), less beside the sheet's border; 0: in no face
};

/// Whether the sight sees it; the depth of the others is not a number.
[[nodiscard]] inline bool seen(const RangeSample& sample) {
  return !std::isnan(sample.depth);
}

struct RangeSheet {
  Sight sight;                       // with its corner set: all columns and rows are at least 3
  std::vector<RangeSample> samples;  // as the scan's points, denoised
  std::vector<Face> faces;
  double noise_spacings = 0;  // deviation across the surface, before the samples were denoised
};

/// Where a surface ends: at longer edges, and at triangles seen more obliquely.
struct SheetLimits {
  double longest_edge_spacings = 6;
  double max_incidence_deg = 85;
};

/// The scan's lattice in triangles (without one, the Delaunay triangulation of the samples as the sight sees
/// them) after its depths were denoised.
[[nodiscard]] RangeSheet range_sheet(const RangeScan& scan, const Rigid3& world_from_scan, const Sight& sight,
                                     const SheetLimits& limits);

}  // namespace drape::meshing
