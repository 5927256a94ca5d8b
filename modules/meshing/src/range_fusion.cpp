#include "range_fusion.hpp"

#include <algorithm>
#include <iterator>

#include "depth_map.hpp"
#include "drape/base/log.hpp"
#include "drape/base/parallel.hpp"
#include "fused_attributes.hpp"
#include "fused_field.hpp"
#include "fusion_blocks.hpp"
#include "marching_cubes.hpp"
#include "sight.hpp"

namespace drape::meshing {
namespace {

constexpr double pixel_spacings = 0.7;

struct SeenScan {
  std::vector<DepthMap> maps;
  std::size_t samples = 0;
};

bool has_attributes(const PointCloud& cloud) {
  return !cloud.colors.empty() || !cloud.intensities.empty() || !cloud.confidences.empty();
}

SeenScan seen_scan(const RangeScan& scan, const Rigid3& world_from_scan, const FusionSizes& sizes) {
  SeenScan seen;
  const double spacing = scan.spacing > 0 ? scan.spacing : sizes.spacing;
  for (const Sight& sight : sights_of(scan, world_from_scan, spacing, pixel_spacings)) {
    const RangeSheet sheet = range_sheet(scan, world_from_scan, sight, sizes.limits);
    if (sheet.faces.empty()) continue;
    seen.samples += static_cast<std::size_t>(std::count_if(
        sheet.samples.begin(), sheet.samples.end(), [](const RangeSample& s) { return s.weight > 0; }));
    seen.maps.push_back(depth_map(sheet, has_attributes(scan.cloud), sizes.limits.longest_edge_spacings));
  }
  return seen;
}

// A few scans at a time, so that not all of the intermediate sheets are there at once.
SeenScan all_seen(std::span<const RangeScan> scans, std::span<const Rigid3> world_from_scan,
                  const FusionSizes& sizes, const Progress& progress) {
  constexpr std::size_t at_a_time = 8;
  SeenScan all;
  for (std::size_t begin = 0; begin < scans.size(); begin += at_a_time) {
    progress.update(static_cast<double>(begin) / static_cast<double>(scans.size()), "denoising the scans");
    std::vector<SeenScan> seen(std::min(at_a_time, scans.size() - begin));
    parallel_for(seen.size(), 1, [&](std::size_t i, std::size_t) {
      seen[i] = seen_scan(scans[begin + i], world_from_scan[begin + i], sizes);
    });
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (!can_be_fused(scans[begin + i]))
        log::warn("{}: neither its view nor a grid with normals is known; fusion leaves it out",
                  scans[begin + i].file);
      all.samples += seen[i].samples;
      for (DepthMap& map : seen[i].maps) {
        map.scan = begin + i;
        all.maps.push_back(std::move(map));
      }
    }
  }
  return all;
}

}  // namespace

bool can_be_fused(const RangeScan& scan) {
  return scan.view.kind != ScanView::Kind::unknown || (scan.grid && !scan.cloud.normals.empty());
}

Fused fused_mesh(std::span<const RangeScan> scans, std::span<const Rigid3> world_from_scan,
                 const FusionSizes& sizes, const Progress& progress) {
  const SeenScan seen = all_seen(scans, world_from_scan, sizes, progress.part(0, 0.4));
  const FusionBlocks blocks = blocks_round(seen.maps, sizes.voxel, FusedField::truncation_voxels);
  const FusedField field = fused_field(blocks, seen.maps, progress.part(0.4, 0.8));
  progress.update(0.8, "marching cubes");
  FieldSurface surface = field_surface(blocks, field);
  progress.update(0.9, "fusing colours");
  fuse_attributes(surface, blocks, seen.maps, scans);
  return {std::move(surface.mesh), seen.samples};
}

}  // namespace drape::meshing
