#include "range_fusion.hpp"

#include <algorithm>
#include <iterator>

#include "depth_map.hpp"
#include "drape/base/log.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "drape/geometry/mesh_packing.hpp"
#include "field_cleaning.hpp"
#include "field_smoothing.hpp"
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
    seen.maps.back().noise = sheet.noise_spacings * spacing;
  }
  return seen;
}

// The scans after `begin` that are worked on at once: not so many that their intermediate sheets, some 150
// bytes a sample, take more memory than what is kept of them all.
std::size_t end_of_round(std::span<const RangeScan> scans, std::size_t begin) {
  constexpr std::size_t most_scans = 8;
  constexpr std::size_t most_samples = 1'000'000;
  std::size_t samples = scans[begin].cloud.size();
  std::size_t end = begin + 1;
  while (end < scans.size() && end < begin + most_scans &&
         (samples += scans[end].cloud.size()) <= most_samples)
    ++end;
  return end;
}

SeenScan all_seen(std::span<const RangeScan> scans, std::span<const Rigid3> world_from_scan,
                  const FusionSizes& sizes, const Progress& progress) {
  SeenScan all;
  for (std::size_t begin = 0; begin < scans.size();) {
    progress.update(static_cast<double>(begin) / static_cast<double>(scans.size()), "denoising the scans");
    std::vector<SeenScan> seen(end_of_round(scans, begin) - begin);
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
    begin += seen.size();
  }
  return all;
}

// Ends of groups of whole layers of blocks, each of a few thousand at least. What touches a group from above
// lies in the next.
std::vector<std::size_t> group_ends(const FusionBlocks& blocks) {
  constexpr std::size_t least_blocks = 4096;
  std::vector<std::size_t> ends;
  std::size_t begin = 0;
  for (std::size_t b = 1; b < blocks.size(); ++b)
    if (b - begin >= least_blocks && blocks.corner(b).z() != blocks.corner(b - 1).z()) {
      ends.push_back(b);
      begin = b;
    }
  ends.push_back(blocks.size());
  return ends;
}

double median_noise(std::span<const DepthMap> maps) {
  std::vector<double> noises;
  for (const DepthMap& map : maps) noises.push_back(map.noise);
  if (noises.empty()) return 0;
  const auto middle = noises.begin() + static_cast<std::ptrdiff_t>(noises.size() / 2);
  std::nth_element(noises.begin(), middle, noises.end());
  return *middle;
}

// Gathers the field group by group, and smooths it.
class FieldSource {
 public:
  FieldSource(const FusionBlocks& blocks, std::span<const DepthMap> maps, std::span<const float> smoothing)
      : blocks_(blocks), maps_(maps), smoothing_(smoothing), ends_(group_ends(blocks)) {}

  [[nodiscard]] std::size_t groups() const { return ends_.size(); }
  /// The end of a group, or of all.
  [[nodiscard]] std::size_t end_of(std::size_t group) const {
    return ends_[std::min(group, ends_.size() - 1)];
  }
  /// Appends the groups up to this one.
  void extend(FusedField& field, std::size_t group) {
    if (smoothing_.empty()) return fuse_blocks(field, blocks_, maps_, end_of(group));
    for (; next_ <= group && next_ < groups(); ++next_) {
      // What touches a group lies in the ones before and after it.
      fuse_blocks(raw_, blocks_, maps_, end_of(next_ + 1));
      smooth_blocks(field, raw_, blocks_, smoothing_, end_of(next_));
      if (next_ > 0) raw_.forget_before(end_of(next_ - 1));
    }
  }

 private:
  const FusionBlocks& blocks_;
  std::span<const DepthMap> maps_;
  std::span<const float> smoothing_;
  std::vector<std::size_t> ends_;
  FusedField raw_;
  std::size_t next_ = 0;
};

// Of the whole mesh only three groups of blocks are there as voxels at a time: the one that becomes faces,
// the one above that its uppermost cubes touch, and the one that those touch.
std::vector<SurfacePart> open_surface(const FusionBlocks& blocks, std::span<const DepthMap> maps,
                                      std::span<const float> smoothing, std::span<const RangeScan> scans,
                                      const Progress& progress) {
  const CommonAttributes common = common_attributes(maps, scans);
  FieldSource source(blocks, maps, smoothing);
  FusedField field;
  MarchingCubes cubes(blocks);
  std::vector<SurfacePart> parts;
  source.extend(field, 1);
  cubes.number(field, source.end_of(0));
  for (std::size_t group = 0; group < source.groups(); ++group) {
    progress.update(static_cast<double>(group) / static_cast<double>(source.groups()), "fusing the scans");
    source.extend(field, group + 2);
    cubes.number(field, source.end_of(group + 1));
    parts.push_back(cubes.part(field, source.end_of(group)));
    fuse_attributes(parts.back(), common, blocks, maps, scans);
    field.forget_before(source.end_of(group));
  }
  return parts;
}

std::vector<SurfacePart> whole_surface(const FusionBlocks& blocks, const FusedField& field) {
  MarchingCubes cubes(blocks);
  cubes.number(field, blocks.size());
  std::vector<SurfacePart> parts;
  parts.push_back(cubes.part(field, blocks.size()));
  return parts;
}

TriangleMesh cleaned(TriangleMesh mesh, double min_component_percent, Fused& fused) {
  Cleaned cleaned = without_folded_border(std::move(mesh));
  fused.touching_vertices = cleaned.removed;
  cleaned = without_touching_border_fans(std::move(cleaned.mesh));
  fused.touching_vertices += cleaned.removed;
  cleaned = without_small_pieces(std::move(cleaned.mesh), min_component_percent);
  fused.pieces_removed = cleaned.removed;
  drop_unused_vertices(cleaned.mesh);
  return std::move(cleaned.mesh);
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
  SeenScan seen = all_seen(scans, world_from_scan, sizes, progress.part(0, 0.4));
  const FusionBlocks blocks = blocks_round(seen.maps, sizes.voxel, FusedField::truncation_voxels);
  Fused fused;
  fused.samples = seen.samples;
  const std::span<const float> smoothing = smoothing_steps(median_noise(seen.maps) / sizes.voxel);
  std::vector<SurfacePart> parts =
      open_surface(blocks, seen.maps, smoothing, scans, progress.part(0.4, sizes.closed ? 0.6 : 0.9));
  if (!sizes.closed) seen.maps = {};
  fused.mesh = cleaned(joined(std::move(parts), blocks), sizes.min_component_percent, fused);
  if (!sizes.closed || fused.mesh.empty()) return fused;

  const TriangleMesh open = std::move(fused.mesh);
  FusedField field;
  FieldSource source(blocks, seen.maps, smoothing);
  source.extend(field, source.groups());
  const CarvedSpace carved = carved_space(blocks, field, seen.maps, open, progress.part(0.7, 0.95));
  parts = whole_surface(carved.blocks, carved.field);
  fuse_attributes(parts.front(), common_attributes(seen.maps, scans), carved.blocks, seen.maps, scans);
  fused.mesh = cleaned(joined(std::move(parts), carved.blocks), sizes.min_component_percent, fused);
  mark_carved_faces(fused.mesh, open, sizes.voxel);
  return fused;
}

}  // namespace drape::meshing
