#include "drape/meshing/mesh_scans.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "advancing_front.hpp"
#include "cleaning.hpp"
#include "drape/base/error.hpp"
#include "drape/base/log.hpp"
#include "drape/base/parallel.hpp"
#include "drape/geometry/kd_tree.hpp"
#include "drape/geometry/mesh_topology.hpp"
#include "drape/meshing/mesh_quality.hpp"
#include "edge_repair.hpp"
#include "grid_delaunay.hpp"
#include "orientation.hpp"
#include "point_merging.hpp"
#include "poisson.hpp"
#include "range_fusion.hpp"
#include "scale_space.hpp"
#include "spot_mending.hpp"
#include "trimming.hpp"
#include "vertex_fans.hpp"

namespace drape::meshing {
namespace {

void check(const MeshInput& input) {
  if (input.scans.size() != input.world_from_scan.size())
    throw Error(ErrorCode::bug, "mesh_scans: not one pose per scan");
  if (!(input.spacing > 0) || !std::isfinite(input.spacing))
    throw input_error("meshing needs the samples' spacing; it is {}", input.spacing);
  const auto wrong = [&](std::size_t size) { return size != 0 && size != input.cloud.size(); };
  if (wrong(input.cloud.normals.size()) || wrong(input.cloud.colors.size()) ||
      wrong(input.cloud.intensities.size()) || wrong(input.cloud.confidences.size()))
    throw Error(ErrorCode::bug, "mesh_scans: an attribute of the cloud is not one per point");
}

// A surface needs samples that span at least a plane.
void check_extent(const PointCloud& samples, double spacing) {
  if (samples.size() < 4)
    throw input_error(
        "four samples apart from each other are the least that make a surface; the merged scans have {}",
        samples.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : samples.positions) mean += p - samples.positions.front();
  mean = samples.positions.front() + mean / static_cast<double>(samples.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : samples.positions) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::Vector3d variance = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
                                       scatter / static_cast<double>(samples.size()), Eigen::EigenvaluesOnly)
                                       .eigenvalues();
  constexpr double least_width_spacings = 1e-3;
  if (std::sqrt(std::max(0.0, variance[1])) < least_width_spacings * spacing)
    throw input_error("all {} samples lie on one line: they make no surface", samples.size());
}

// Whether most of the merged cloud's normals point away from the scanners. A few thousand samples tell.
bool normals_point_away(const MeshInput& input, const PointCloud& samples, const KdTree& tree) {
  if (samples.normals.empty()) return false;
  constexpr std::size_t samples_per_scan = 1000;
  std::ptrdiff_t towards = 0;
  for (std::size_t s = 0; s < input.scans.size(); ++s) {
    const RangeScan& scan = input.scans[s];
    if (scan.view.kind == ScanView::Kind::unknown) continue;
    const std::size_t step = std::max<std::size_t>(1, scan.cloud.size() / samples_per_scan);
    for (std::size_t i = 0; i < scan.cloud.size(); i += step) {
      const Eigen::Vector3d& p = scan.cloud.positions[i];
      Neighbor nearest{};
      if (!p.allFinite() || tree.nearest(input.world_from_scan[s] * p, {&nearest, 1}) == 0) continue;
      const Eigen::Vector3d to_scanner = input.world_from_scan[s].linear() * scan.view.towards_scanner(p);
      towards += samples.normals[nearest.index].cast<double>().dot(to_scanner) >= 0 ? 1 : -1;
    }
  }
  return towards < 0;
}

bool any_view_known(const MeshInput& input) {
  return std::any_of(input.scans.begin(), input.scans.end(),
                     [](const RangeScan& s) { return s.view.kind != ScanView::Kind::unknown; });
}

// Per face: positive where the samples' normals agree with it, weighed by its area.
std::vector<double> normal_votes(const TriangleMesh& mesh, const PointCloud& samples, const KdTree& tree) {
  std::vector<double> votes(mesh.faces.size(), 0);
  if (samples.normals.empty()) return votes;
  parallel_for(votes.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Face& f = mesh.faces[i];
      Neighbor nearest{};
      tree.nearest((mesh.vertices[f[0]] + mesh.vertices[f[1]] + mesh.vertices[f[2]]) / 3, {&nearest, 1});
      votes[i] = scaled_face_normal(mesh, i).dot(samples.normals[nearest.index].cast<double>());
    }
  });
  return votes;
}

void take_attributes(TriangleMesh& mesh, const PointCloud& samples, const KdTree& tree) {
  const auto copy = [&](auto& to, const auto& from) {
    to.clear();
    if (from.empty()) return;
    to.resize(mesh.vertices.size());
    parallel_for(to.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        Neighbor nearest{};
        tree.nearest(mesh.vertices[v], {&nearest, 1});
        to[v] = from[nearest.index];
      }
    });
  };
  copy(mesh.colors, samples.colors);
  copy(mesh.intensities, samples.intensities);
  copy(mesh.confidences, samples.confidences);
}

// Closed pieces without a normal or a view to say where outside is.
TriangleMesh with_positive_volume(const TriangleMesh& mesh) {
  const MeshTopology topology = mesh_topology(mesh);
  if (!topology.closed_manifold() || signed_volume(mesh) >= 0) return mesh;
  TriangleMesh turned = mesh;
  for (Face& f : turned.faces) std::swap(f[1], f[2]);
  return turned;
}

// Whether the faces are of one surface, which must not cross itself.
enum class Sheets { one, several };

// What every method's raw faces go through (those of fusion do within it).
void clean(const MeshOptions& options, Sheets sheets, MeshResult& result) {
  Cleaned cleaned = without_bad_faces(result.mesh);
  cleaned = with_manifold_edges(cleaned.mesh);
  result.non_manifold_repaired += cleaned.removed;
  cleaned = without_touching_fans(cleaned.mesh);
  result.non_manifold_repaired += cleaned.removed;
  cleaned = without_small_components(cleaned.mesh, options.min_component_percent);
  result.components_removed = cleaned.removed;
  result.mesh = std::move(cleaned.mesh);
  if (sheets == Sheets::several) {
    result.self_intersections = self_intersecting_pairs(result.mesh).size();
    return;
  }
  Uncrossed uncrossed = with_crossings_mended(result.mesh);
  result.self_intersections_repaired = uncrossed.found - uncrossed.left;
  result.self_intersections = uncrossed.left;
  result.mesh = std::move(uncrossed.mesh);
}

MeshResult mesh_merged_cloud(const MeshInput& input, Method method, const MeshOptions& options,
                             const Progress& progress) {
  const double spacing = input.spacing;
  progress.update(0.0, "merging the samples");
  PointCloud samples = merged_on_voxels(input.cloud, options.merge_voxel_spacings * spacing);
  check_extent(samples, spacing);
  const KdTree tree(samples.positions);

  MeshResult result;
  result.samples_used = samples.size();
  if (normals_point_away(input, samples, tree)) {
    result.normals_reversed = true;
    log::warn("the cloud's normals point away from the scanners: they are taken the other way round");
    for (Eigen::Vector3f& n : samples.normals) n = -n;
  }
  const double trim = options.trim_spacings * spacing;
  if (method == Method::poisson) {
    if (samples.normals.empty())
      throw input_error("mesh.method poisson needs samples with normals, and the cloud has none");
    const double sample_spacing = std::max(1.0, options.merge_voxel_spacings) * spacing;
    result.mesh = poisson_mesh(samples,
                               {sample_spacing, options.poisson_radius_spacings * spacing,
                                options.poisson_distance_spacings * spacing},
                               progress.part(0.05, 0.9));
  } else if (method == Method::scale_space) {
    progress.update(0.05, "smoothing, and advancing front");
    constexpr double radius_spacings = 3;
    const double sample_spacing = std::max(1.0, options.merge_voxel_spacings) * spacing;
    result.mesh = scale_space_mesh(samples, radius_spacings * sample_spacing, 4 * trim);
  } else {
    progress.update(0.05, "advancing front");
    result.mesh = advancing_front_mesh(samples, 4 * trim);
  }
  progress.update(0.9, "cleaning the mesh");
  // CGAL visits its cells in the order of their addresses.
  Cleaned trimmed = trimmed_to_samples(in_canonical_order(result.mesh), samples, trim);
  result.faces_trimmed = trimmed.removed;
  result.mesh = std::move(trimmed.mesh);
  result.mesh = oriented_by_votes(result.mesh, normal_votes(result.mesh, samples, tree));
  clean(options, Sheets::one, result);
  if (samples.normals.empty() || !any_view_known(input)) result.mesh = with_positive_volume(result.mesh);
  take_attributes(result.mesh, samples, tree);
  return result;
}

// An attribute is kept if every scan has it.
template <class Attribute>
void append(std::vector<Attribute>& to, const std::vector<Attribute>& from, std::size_t vertices_before) {
  if (to.size() == vertices_before) to.insert(to.end(), from.begin(), from.end());
}

void append_sheet(TriangleMesh& mesh, const TriangleMesh& sheet, const Rigid3& world_from_scan) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  append(mesh.colors, sheet.colors, offset);
  append(mesh.intensities, sheet.intensities, offset);
  append(mesh.confidences, sheet.confidences, offset);
  for (const Eigen::Vector3d& p : sheet.vertices) mesh.vertices.push_back(world_from_scan * p);
  for (const Face& f : sheet.faces) mesh.faces.push_back({f[0] + offset, f[1] + offset, f[2] + offset});
}

template <class Attribute>
void drop_if_partial(std::vector<Attribute>& values, const TriangleMesh& mesh) {
  if (values.size() != mesh.vertices.size()) values.clear();
}

MeshResult mesh_grids(const MeshInput& input, const MeshOptions& options, const Progress& progress) {
  MeshResult result;
  std::size_t grids = 0;
  for (std::size_t s = 0; s < input.scans.size(); ++s) {
    const RangeScan& scan = input.scans[s];
    progress.update(static_cast<double>(s) / static_cast<double>(input.scans.size()),
                    "triangulating the grids");
    if (!scan.grid) {
      log::warn("{} has no range grid: mesh.method grid leaves it out", scan.file);
      continue;
    }
    ++grids;
    result.samples_used += scan.cloud.size();
    const double spacing = scan.spacing > 0 ? scan.spacing : input.spacing;
    append_sheet(result.mesh,
                 grid_mesh(scan, options.grid_max_edge_spacings * spacing, options.grid_max_incidence_deg),
                 input.world_from_scan[s]);
  }
  if (grids == 0)
    throw input_error("mesh.method grid needs scans with a range grid, and none of the {} has one",
                      input.scans.size());
  drop_if_partial(result.mesh.colors, result.mesh);
  drop_if_partial(result.mesh.intensities, result.mesh);
  drop_if_partial(result.mesh.confidences, result.mesh);
  clean(options, grids == 1 ? Sheets::one : Sheets::several, result);
  return result;
}

bool all_can_be_fused(std::span<const RangeScan> scans) {
  return !scans.empty() && std::all_of(scans.begin(), scans.end(), can_be_fused);
}

Method chosen_method(const MeshInput& input, Method asked) {
  if (asked != Method::automatic) return asked;
  if (all_can_be_fused(input.scans)) return Method::fusion;
  return input.cloud.normals.empty() ? Method::advancing_front : Method::poisson;
}

MeshResult fuse(const MeshInput& input, const MeshOptions& options, const Progress& progress) {
  if (std::none_of(input.scans.begin(), input.scans.end(), can_be_fused))
    throw input_error(
        "mesh.method fusion needs to know from where, or in which direction, the scans looked, and knows it "
        "for "
        "none of the {}",
        input.scans.size());
  Fused fused = fused_mesh(input.scans, input.world_from_scan,
                           {input.spacing,
                            options.fusion_voxel_spacings * input.spacing,
                            options.closed,
                            options.min_component_percent,
                            {options.grid_max_edge_spacings, options.grid_max_incidence_deg}},
                           progress.part(0, 0.95));
  progress.update(0.95);
  MeshResult result;
  result.samples_used = fused.samples;
  result.non_manifold_repaired = fused.touching_vertices;
  result.components_removed = fused.pieces_removed;
  result.mesh = std::move(fused.mesh);
  return result;
}

MeshResult meshed(const MeshInput& input, Method method, const MeshOptions& options,
                  const Progress& progress) {
  switch (method) {
    case Method::fusion:
      return fuse(input, options, progress);
    case Method::grid:
      return mesh_grids(input, options, progress);
    default:
      return mesh_merged_cloud(input, method, options, progress);
  }
}

std::string_view why_empty(Method method, bool closed) {
  switch (method) {
    case Method::fusion:
      if (closed)
        return "closed: true, and no space is left behind it that no scan saw to be empty: it is flat, or no "
               "three of a scan lie within grid_max_edge_spacings and grid_max_incidence_deg";
      return "no three of a scan lie within grid_max_edge_spacings and grid_max_incidence_deg";
    case Method::poisson:
      return "their normals enclose nothing, or all of it is farther than trim_spacings off";
    default:
      return "all of them are farther apart than the limits allow";
  }
}

}  // namespace

bool needs_cloud(std::span<const RangeScan> scans, Method method) {
  if (method == Method::automatic) return !all_can_be_fused(scans);
  return method != Method::fusion && method != Method::grid;
}

MeshResult mesh_scans(const MeshInput& input, const MeshOptions& options, const Progress& progress) {
  check(input);
  const Method method = chosen_method(input, options.method);
  MeshResult result = meshed(input, method, options, progress);
  result.method = method;
  if (result.mesh.empty())
    throw input_error("meshing found no surface in {} samples: {}", result.samples_used,
                      why_empty(method, options.closed));
  result.mesh.normals = vertex_normals(result.mesh);
  progress.update(1.0);
  return result;
}

}  // namespace drape::meshing
