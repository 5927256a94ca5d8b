// Volumetric fusion of range scans.
#pragma once

#include <cstddef>
#include <span>

#include "drape/base/progress.hpp"
#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/rigid3.hpp"
#include "drape/geometry/triangle_mesh.hpp"
#include "range_sheet.hpp"

namespace drape::meshing {

struct FusionSizes {
  double spacing;                // of samples, for scans that do not know theirs
  double voxel;                  // same unit
  bool closed;                   // carve space instead of leaving holes
  double min_component_percent;  // pieces with a smaller share of all faces are removed
  SheetLimits limits;
};

struct Fused {
  TriangleMesh mesh;
  std::size_t samples = 0;            // that are part of the surface of a scan
  std::size_t touching_vertices = 0;  // where fans of faces touched, or the border was folded
  std::size_t pieces_removed = 0;
};

/// Whether the scan can be fused: its view is known, or it has a grid and normals.
[[nodiscard]] bool can_be_fused(const RangeScan& scan);

/// The surface that the scans agree on, open where none saw it (or closed there, with those faces `filled`)
/// (Curless and Levoy 1996, "A volumetric method for building complex models from range images"): each scan
/// is denoised on its own lattice, triangulated and drawn as a depth map; sparse blocks of voxels near the
/// surfaces gather their signed distances, which are smoothed where the noise was large; marching cubes. With
/// colours, intensities and confidences where all scans have them. Scans that cannot be fused are left out.
[[nodiscard]] Fused fused_mesh(std::span<const RangeScan> scans, std::span<const Rigid3> world_from_scan,
                               const FusionSizes& sizes, const Progress& progress);

}  // namespace drape::meshing
