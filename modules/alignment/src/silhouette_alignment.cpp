#include "silhouette_alignment.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <utility>

#include "color_appearance.hpp"
#include "color_evidence.hpp"
#include "color_occlusion.hpp"
#include "color_verdict.hpp"
#include "distinct_poses.hpp"
#include "drape/alignment/overlap.hpp"
#include "drape/base/error.hpp"
#include "drape/rendering/renderer.hpp"
#include "image_stencil.hpp"
#include "near_search.hpp"
#include "outline_figures.hpp"
#include "photo_plane.hpp"
#include "pose_search.hpp"
#include "pose_verdict.hpp"
#include "rough_outline.hpp"
#include "simplified_mesh.hpp"
#include "stencil_evidence.hpp"

namespace drape::alignment {
namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr int coarse_faces = 1500;
constexpr int middle_faces = 8000;
constexpr double fits_well = 0.965;          // of an outline: with less there may be a better pose near by
constexpr double smooth_distance_px = 0.03;  // of a smooth outline, in the mean
constexpr int least_object_px = 8;

MeshLevels mesh_levels(const TriangleMesh& mesh, const UnitSphere& sphere) {
  MeshLevels levels;
  const TriangleMesh middle = simplified_mesh(mesh, middle_faces);
  levels.full = outline_mesh(mesh, sphere);
  levels.middle = outline_mesh(middle, sphere);
  levels.coarse = outline_mesh(simplified_mesh(middle, coarse_faces), sphere);
  return levels;
}

LensPrior lens_prior(const PhotoEvidence& evidence, const AlignOptions& options, const PhotoPlane& plane) {
  LensPrior lens;
  lens.photo_width_px = evidence.stencil.width();
  lens.orthographic = options.projection == Camera::Projection::orthographic;
  lens.hinted_focal_px = evidence.focal_px_prior;
  if (options.fov_deg)
    lens.fixed_focal_px = evidence.stencil.width() / 2.0 / std::tan(*options.fov_deg * radians / 2);
  if (options.focal_px) lens.fixed_focal_px = options.focal_px;
  if (plane.focal_px()) lens.fixed_focal_px = plane.focal_px();
  if (lens.orthographic) lens.fixed_focal_px.reset();
  return lens;
}

SearchSettings search_settings(const PhotoEvidence& evidence, const AlignOptions& options,
                               const PhotoPlane& plane, const UnitSphere& sphere) {
  SearchSettings settings;
  settings.lens = lens_prior(evidence, options, plane);
  settings.principal_point_known = evidence.lens.has_value();
  if (evidence.initial_camera) {
    const std::optional<OutlinePose> start = pose_of(*evidence.initial_camera, sphere, plane.principal_px());
    if (!start) throw config_error("the initial camera does not look at the mesh");
    settings.starts = {*start};
    settings.starts.front().principal.setZero();
  }
  if (options.max_roll_deg && evidence.up) {
    const Eigen::Vector3d up = evidence.up->normalized();
    const double most = *options.max_roll_deg * radians;
    settings.allowed = [up, most](const OutlinePose& pose) {
      const Eigen::Vector3d seen = pose.rotation * up;
      // Looked at from straight above or below, nothing is up.
      return seen.head<2>().norm() < 0.2 || std::abs(std::atan2(seen.x(), -seen.y())) <= most;
    };
  }
  return settings;
}

// The poses as cameras, the best first, with what is to be thought of them.
Alignment judged(const std::vector<RefinedPose>& poses, OutlineFigures figures,
                 const SearchSettings& settings, const PhotoEvidence& evidence, const SoughtMesh& sought,
                 const PhotoPlane& plane, const AlignOptions& options) {
  const TriangleMesh& mesh = sought.mesh;
  const UnitSphere& sphere = sought.sphere;
  Alignment alignment;
  alignment.evidence = options.evidence;
  alignment.camera.width = evidence.stencil.width();
  alignment.camera.height = evidence.stencil.height();
  std::vector<RefinedPose> ranked = poses;
  const bool by_colors = alignment.evidence != EvidenceKind::stencil;
  if (by_colors) {
    rendering::Renderer renderer(mesh);
    rank_by_appearance(ranked, [&](const OutlinePose& pose) {
      return explained_colors(mesh, renderer, *evidence.photo, plane,
                              camera_of(pose, sphere, options.projection, plane.principal_px(),
                                        evidence.stencil.width(), evidence.stencil.height()));
    });
  }
  PoseJudgement judgement =
      by_colors ? judge_color_poses(ranked, settings.lens) : judge_poses(ranked, settings.lens, figures);
  std::vector<Camera> cameras;
  for (const RefinedPose& pose : ranked)
    cameras.push_back(camera_of(pose.pose, sphere, options.projection, plane.principal_px(),
                                evidence.stencil.width(), evidence.stencil.height()));
  alignment.verdict = judgement.verdict;
  alignment.reasons = judgement.reasons;
  for (std::size_t i = 0; i < ranked.size(); ++i)
    alignment.candidates.push_back({cameras[i], 100 * ranked[i].agreement.overlap,
                                    ranked[i].agreement.score(),
                                    i == 0                  ? judgement.verdict
                                    : i <= judgement.rivals ? Verdict::review
                                                            : Verdict::reject});
  if (ranked.empty()) return alignment;
  const Agreement& best = ranked.front().agreement;
  alignment.camera = cameras.front();
  alignment.overlap_percent = 100 * best.overlap;
  alignment.inlier_fraction = 0.5 * (best.rim_inliers + best.image_inliers);
  if (alignment.inlier_fraction > 0) alignment.boundary_error_px = best.rms_px;
  if (by_colors) {
    alignment.inlier_fraction = best.image_inliers;
    alignment.edge_support = best.rim_inliers;
  }
  alignment.sigma = judgement.sigma;
  if (!by_colors) alignment.outline = figures;
  if (judgement.free_axis) alignment.free_axis = FreeAxis{sphere.center, *judgement.free_axis};
  return alignment;
}

// The outline filled, and unknown where something hides the object.
Image8 visible_stencil(const TriangleMesh& mesh, const OutlineMesh& outline, const ColorEvidence& colors,
                       const PhotoPlane& plane, const UnitSphere& sphere, const Camera& camera) {
  Image8 stencil = rendering::Renderer(mesh).stencil(camera);
  const std::optional<OutlinePose> pose = pose_of(camera, sphere, plane.principal_px());
  if (!pose) return stencil;
  OutlineDrawing drawing;
  const Window& window = colors.finest().window;
  drawing.draw(outline, *pose, window, false);
  const Image8 hidden = hidden_pixels(colors.finest(), drawing);
  for (int y = 0; y < stencil.height(); ++y)
    for (int x = 0; x < stencil.width(); ++x) {
      if (stencil.at(x, y) != stencil::object) continue;
      const Eigen::Vector2d at = window.from_photo(Eigen::Vector2d(x + 0.5, y + 0.5) - plane.principal_px());
      const int u = static_cast<int>(std::floor(at.x()));
      const int v = static_cast<int>(std::floor(at.y()));
      if (hidden.contains(u, v) && hidden.at(u, v) != 0) stencil.at(x, y) = stencil::unknown;
    }
  return stencil;
}

// What the options' kind of evidence says.
std::unique_ptr<Evidence> chosen_evidence(const PhotoEvidence& evidence, const AlignOptions& options,
                                          const PhotoPlane& plane) {
  if (options.evidence == EvidenceKind::colour) {
    if (evidence.photo == nullptr) throw config_error("align.evidence: colour needs the photo");
    return std::make_unique<ColorEvidence>(*evidence.photo, plane, color_place(evidence));
  }
  if (options.evidence == EvidenceKind::segments) {
    if (evidence.photo == nullptr || evidence.segments == nullptr)
      throw config_error("align.evidence: segments needs the photo and its segments");
    return std::make_unique<ColorEvidence>(*evidence.segments, plane, color_place(evidence));
  }
  check_stencil(evidence.stencil);
  if (object_extent(evidence.stencil) < least_object_px)
    throw input_error(
        "the object in the stencil is too small: {} pixels at its longest, and it must be {} at least",
        object_extent(evidence.stencil), least_object_px);
  return std::make_unique<StencilEvidence>(evidence.stencil, plane);
}

// Whether a pose next to this one may fit better: much of the outline does not fit, or of a smooth outline
// all of it fits, but not as the right pose's would. An open mesh's overlap tells nothing.
bool worth_looking_near(const SettledPoses& settled, const OutlineFigures& figures, const OutlineMesh& mesh,
                        const StencilEvidence& stencil) {
  if (figures.fits < fits_well) return true;
  return !mesh.open && settled.smooth &&
         stencil.mean_distance_px(settled.poses.front().agreement.overlap) > smooth_distance_px;
}

struct SettledOutline {
  SettledPoses settled;
  OutlineFigures figures;
};

SettledOutline settled_on_outline(const std::vector<RefinedPose>& found, const MeshLevels& meshes,
                                  const StencilEvidence& stencil, double object_px,
                                  const SearchSettings& settings, const std::optional<PhotoInside>& inside,
                                  const Progress& progress) {
  const auto settle = [&](const std::vector<RefinedPose>& poses) {
    SettledOutline result{settled_poses(poses, meshes.full, stencil, settings.lens, inside, progress), {}};
    // Some may have become the same.
    result.settled.poses = distinct_poses(std::move(result.settled.poses), poses.size());
    result.figures = outline_figures(meshes.full, result.settled.poses.front().pose, stencil,
                                     result.settled.noise, object_px);
    result.figures.by_photo = result.settled.shaded;
    if (result.settled.inside) {
      result.figures.explained = result.settled.inside->explained;
      result.figures.independent = result.settled.inside->independent;
    }
    return result;
  };
  SettledOutline first = settle(found);
  if (!worth_looking_near(first.settled, first.figures, meshes.full, stencil)) return first;
  std::vector<RefinedPose> all =
      search_near(first.settled.poses.front().pose, meshes, stencil, settings.lens, progress);
  if (settings.allowed)
    std::erase_if(all, [&](const RefinedPose& pose) { return !settings.allowed(pose.pose); });
  all.insert(all.end(), found.begin(), found.end());
  return settle(distinct_poses(std::move(all), found.size() + 1));
}

}  // namespace

SoughtMesh::SoughtMesh(const TriangleMesh& whole)
    : mesh(whole), sphere(unit_sphere(whole)), levels(mesh_levels(whole, sphere)) {}

Alignment align_silhouette(const SoughtMesh& sought, const PhotoEvidence& evidence,
                           const AlignOptions& options, const Progress& progress) {
  progress.update(0, "reading the photo");
  const auto& [mesh, sphere, meshes] = sought;
  const PhotoPlane plane(evidence.stencil.width(), evidence.stencil.height(), evidence.lens);
  const std::unique_ptr<Evidence> outline = chosen_evidence(evidence, options, plane);
  progress.update(0.05, "drawing views");
  SearchSettings settings = search_settings(evidence, options, plane, sphere);
  settings.principal_point_known |= options.evidence != EvidenceKind::stencil;
  const PoseSearchResult found = search_poses(meshes, *outline, settings, progress.part(0.05, 0.95));

  std::vector<RefinedPose> poses = found.poses;
  OutlineFigures figures;
  if (const auto* stencil = dynamic_cast<const StencilEvidence*>(outline.get()); stencil && !poses.empty()) {
    std::optional<PhotoInside> inside;
    if (evidence.photo != nullptr) inside.emplace(PhotoInside{*evidence.photo, plane, mesh.colors});
    SettledOutline settled = settled_on_outline(found.poses, meshes, *stencil,
                                                object_extent(evidence.stencil), settings, inside, progress);
    poses = std::move(settled.settled.poses);
    figures = settled.figures;
  }
  Alignment alignment = judged(poses, figures, settings, evidence, sought, plane, options);
  if (const auto* colors = dynamic_cast<const ColorEvidence*>(outline.get());
      colors && !found.poses.empty()) {
    alignment.stencil = visible_stencil(mesh, meshes.full, *colors, plane, sphere, alignment.camera);
    alignment.overlap_percent = overlap_percent(alignment.stencil, evidence.stencil);
  }
  alignment.metrics.pass1_seconds = found.statistics.coarse_seconds;
  alignment.metrics.candidates_listed = found.statistics.candidates_listed;
  alignment.metrics.candidates_tried = found.statistics.candidates_tried;
  progress.update(1, "judging");
  return alignment;
}

}  // namespace drape::alignment
