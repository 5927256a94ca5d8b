#include "range_fusion.hpp"

#include <algorithm>
#include <iterator>

#include "depth_map.hpp"
#include "drape/base/log.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "field_cleaning.hpp"
#include "fused_attributes.hpp"
#include "fused_field.hpp"
#include "fusion_blocks.hpp"
#include "marching_cubes.hpp"
#include "sight.hpp"
#include "space_carving.hpp"

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

void clean(FieldSurface& surface, double min_component_percent, Fused& fused) {
  Cleaned cleaned = without_touching_border_fans(std::move(surface.mesh));
  fused.touching_vertices = cleaned.removed;
  cleaned = without_small_pieces(std::move(cleaned.mesh), min_component_percent);
  fused.pieces_removed = cleaned.removed;
  surface.mesh = std::move(cleaned.mesh);
}

// Faces that no vertex of the open surface is near.
void mark_carved_faces(TriangleMesh& mesh, const TriangleMesh& open, double voxel) {
  const KdTree tree(open.vertices);
  mesh.filled.assign(mesh.faces.size(), 0);
  parallel_for(mesh.faces.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Face& f = mesh.faces[i];
      const Eigen::Vector3d middle = (mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3;
      mesh.filled[i] = tree.nearest_within(middle, 1.5 * voxel) ? 0 : 1;
    }
  });
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
  Fused fused;
  fused.samples = seen.samples;
  FieldSurface surface = field_surface(blocks, field);
  clean(surface, sizes.min_component_percent, fused);
  if (!sizes.closed || surface.mesh.empty()) {
    progress.update(0.9, "fusing colours");
    fuse_attributes(surface, blocks, seen.maps, scans);
    fused.mesh = without_unused_vertices(surface.mesh);
    return fused;
  }
  const TriangleMesh open = without_unused_vertices(surface.mesh);
  const CarvedSpace carved = carved_space(blocks, field, seen.maps, open, progress.part(0.8, 0.95));
  surface = field_surface(carved.blocks, carved.field);
  clean(surface, sizes.min_component_percent, fused);
  fuse_attributes(surface, carved.blocks, seen.maps, scans);
  fused.mesh = without_unused_vertices(surface.mesh);
  mark_carved_faces(fused.mesh, open, sizes.voxel);
  return fused;
}

}  // namespace drape::meshing
