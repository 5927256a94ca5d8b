// A scan as the search for its place looks at it.
#pragma once

#include "coarse_scan.hpp"
#include "outline.hpp"
#include "point_features.hpp"
#include "scan_surface.hpp"
#include "sight_map.hpp"
#include "smooth_sight.hpp"

namespace drape::registration {

/// Refers to the surface.
struct SearchedScan {
  SearchedScan(const ScanSurface& of, double voxel)
      : surface(&of),
        coarse(of, voxel),
        features(point_features(coarse)),
        sight(of),
        smooth_sight(of, coarse),
        outline(of) {}

  const ScanSurface* surface;
  CoarseScan coarse;
  Features features;
  SightMap sight;
  SmoothSight smooth_sight;
  Outline outline;
};

}  // namespace drape::registration
