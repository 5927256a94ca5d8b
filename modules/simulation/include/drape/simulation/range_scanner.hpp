// A virtual range scanner.
#pragma once

#include <cstdint>

#include "drape/geometry/range_scan.hpp"
#include "drape/geometry/ray_caster.hpp"
#include "drape/geometry/rigid3.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::simulation {

enum class Rays {
  diverging,  // from one origin, at equal steps of the angles of azimuth and elevation
  parallel    // along one direction, from a square lattice
};

/// The scanner's frame is that of its scans: x right, y down, z forward, its origin at the scanner.
struct ScannerSpec {
  Rays rays = Rays::diverging;
  int rows = 128;
  int columns = 128;
  double pitch_deg = 0.1;  // of diverging rays, both ways
  double pitch_m = 0.001;  // of parallel rays, both ways
  double noise_m = 0;      // standard deviation of the range at normal incidence; grows as 1 / cos(incidence)
  double max_incidence_deg = 80;   // surfaces seen at a larger angle from their normal return nothing
  double mixed_pixel_percent = 0;  // of the samples beside a depth edge: they land between the two surfaces
  bool intensity = false;          // of the return: the surface's brightness by the cosine of incidence
  bool color = false;              // as the mesh's vertex colours have it
  std::uint64_t seed = 0;
};

/// One scan, in the scanner's frame, with grid, view and world_from_scan = world_from_scanner (the truth).
/// Row 0 is the topmost (least y), column 0 the leftmost. Each ray returns its first hit, with noise along
/// the ray; it returns nothing where it hits nothing, grazes, or hits the inner side of a face. A mixed pixel
/// arises where a lattice neighbour's ray hits another surface: farther apart than one surface at the
/// incidence limit could make it. Neither depends on the number of threads. `caster` holds `mesh`; intensity
/// and colour need mesh.colors.
[[nodiscard]] RangeScan scan(const TriangleMesh& mesh, const RayCaster& caster,
                             const Rigid3& world_from_scanner, const ScannerSpec& spec);
[[nodiscard]] RangeScan scan(const TriangleMesh& mesh, const Rigid3& world_from_scanner,
                             const ScannerSpec& spec);

}  // namespace drape::simulation
