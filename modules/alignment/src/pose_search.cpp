#include "pose_search.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>

#include "chamfer_search.hpp"
#include "distinct_poses.hpp"
#include "drape/base/parallel.hpp"
#include "view_atlas.hpp"

namespace drape::alignment {
namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr int atlas_views = 400;
constexpr int outline_views = 1000;
constexpr std::size_t glanced_views = 10;  // one of so many tells whether a frame is worth all of them
constexpr double usual_perspective = 0.2;
constexpr double distinct_rad = 10 * radians;
constexpr double distinct_match_rad = 6 * radians;  // of candidates of the coarse search
constexpr std::size_t chamfer_matches_kept = 2500;
constexpr double principal_point_gain = 200;  // of chi squared

struct Candidate {
  float score = 0;
  std::size_t frame = 0;
  std::size_t view = 0;
  int roll = 0;
};

Eigen::Matrix3d roll_matrix(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// The rolls that score better than those beside them. A disc scores alike at all of them: then one stands for
// all.
std::vector<int> best_rolls(const std::array<float, polar_angles>& scores) {
  std::vector<int> rolls;
  for (int r = 0; r < polar_angles; ++r) {
    const float here = scores[static_cast<std::size_t>(r)];
    const float before = scores[static_cast<std::size_t>((r + polar_angles - 1) % polar_angles)];
    const float after = scores[static_cast<std::size_t>((r + 1) % polar_angles)];
    if (here > before && here >= after) rolls.push_back(r);
  }
  if (rolls.empty()) rolls.push_back(0);
  return rolls;
}

class CoarseSearch {
 public:
  CoarseSearch(const MeshLevels& meshes, const Evidence& evidence, const SearchSettings& settings)
      : mesh_(meshes.coarse), evidence_(evidence), settings_(settings) {
    const PolarFrame frame = evidence.frames(0).front();
    perspective_ = expected_perspective(frame);
    views_ = view_atlas(mesh_, atlas_views, perspective_);
  }

  /// Distinct starting poses, best first. With effort 1 the evidence is taken to be wrong in part.
  [[nodiscard]] std::vector<OutlinePose> starts(int effort, std::size_t most) const {
    const bool outline = effort > 0 && evidence_.outline() != nullptr;
    return distinct(outline ? by_outline() : by_frames(effort), outline ? distinct_match_rad : distinct_rad,
                    most);
  }

  [[nodiscard]] std::size_t listed(int effort) const {
    return evidence_.frames(effort).size() * views_.size() * polar_angles;
  }

 private:
  [[nodiscard]] double expected_perspective(const PolarFrame& frame) const {
    if (settings_.lens.orthographic) return 0;
    const std::optional<double> focal =
        settings_.lens.fixed_focal_px ? settings_.lens.fixed_focal_px : settings_.lens.hinted_focal_px;
    if (!focal) return usual_perspective;
    // A body's radius of gyration in a picture is about half its bounding sphere's.
    return std::clamp(2 * frame.radius / evidence_.window(0).px_per_photo_px / *focal, 0.0, 0.6);
  }
  [[nodiscard]] std::vector<OutlinePose> by_frames(int effort) const;
  [[nodiscard]] std::vector<OutlinePose> by_outline() const;
  [[nodiscard]] std::vector<OutlinePose> distinct(const std::vector<OutlinePose>& sorted, double apart_rad,
                                                  std::size_t most) const;
  [[nodiscard]] OutlinePose pose_of(const Candidate& candidate, const PolarFrame& frame) const;
  [[nodiscard]] OutlinePose pose_of(const AtlasView& view, double angle, double scale,
                                    const Eigen::Vector2d& shift, const Eigen::Vector2d& center) const;
  [[nodiscard]] std::vector<PolarFrame> promising(std::vector<PolarFrame> frames) const;

  const OutlineMesh& mesh_;
  const Evidence& evidence_;
  const SearchSettings& settings_;
  double perspective_ = 0;
  std::vector<AtlasView> views_;
};

// The view was drawn in the middle of the picture: the same look elsewhere is that of a body turned along
// with the ray that it lies on. `scale`, `shift` and the body's `center` are in photo pixels.
OutlinePose CoarseSearch::pose_of(const AtlasView& view, double angle, double scale,
                                  const Eigen::Vector2d& shift, const Eigen::Vector2d& center) const {
  OutlinePose pose;
  pose.scale = scale;
  pose.shift = shift;
  pose.rotation = roll_matrix(angle) * view.rotation;
  if (settings_.lens.orthographic) return pose;
  pose.perspective = settings_.lens.fixed_focal_px ? pose.scale / *settings_.lens.fixed_focal_px
                                                   : perspective_prior(settings_.lens, pose.scale).mean;
  pose.perspective = std::min(pose.perspective, 0.7);
  const double focal = pose.scale / std::max(pose.perspective, 1e-6);
  const Eigen::Vector3d ray(center.x(), center.y(), focal);
  pose.rotation =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), ray).toRotationMatrix() * pose.rotation;
  return pose;
}

OutlinePose CoarseSearch::pose_of(const Candidate& candidate, const PolarFrame& frame) const {
  const AtlasView& view = views_[candidate.view];
  const Window& window = evidence_.window(0);
  const double angle = 2 * std::numbers::pi * candidate.roll / polar_angles;
  const double scale = frame.radius / view.frame.radius / window.px_per_photo_px;
  const Eigen::Vector2d center = window.to_photo(frame.center);
  return pose_of(view, angle, scale, center - scale * (Eigen::Rotation2Dd(angle) * view.frame.center),
                 center);
}

// Where some of the views fit best, in the order given.
std::vector<PolarFrame> CoarseSearch::promising(std::vector<PolarFrame> frames) const {
  const std::size_t most = evidence_.plan().most_frames;
  if (frames.size() <= most) return frames;
  std::vector<float> best(frames.size(), 0);
  parallel_for(frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const std::unique_ptr<Evidence::RollScores> rolls = evidence_.rolls(frames[f]);
      for (std::size_t v = f % glanced_views; v < views_.size(); v += glanced_views) {
        std::array<float, polar_angles> scores{};
        rolls->score(views_[v].bits, scores);
        best[f] = std::max(best[f], *std::max_element(scores.begin(), scores.end()));
      }
    }
  });
  std::vector<std::size_t> order(frames.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return best[a] > best[b]; });
  order.resize(most);
  std::sort(order.begin(), order.end());
  std::vector<PolarFrame> kept;
  for (const std::size_t f : order) kept.push_back(frames[f]);
  return kept;
}

std::vector<OutlinePose> CoarseSearch::by_frames(int effort) const {
  const std::vector<PolarFrame> frames = promising(evidence_.frames(effort));
  std::vector<std::vector<Candidate>> found(frames.size() * views_.size());
  parallel_for(frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const std::unique_ptr<Evidence::RollScores> rolls = evidence_.rolls(frames[f]);
      for (std::size_t v = 0; v < views_.size(); ++v) {
        std::array<float, polar_angles> scores{};
        rolls->score(views_[v].bits, scores);
        for (const int r : best_rolls(scores))
          found[f * views_.size() + v].push_back({scores[static_cast<std::size_t>(r)], f, v, r});
      }
    }
  });
  std::vector<Candidate> all;
  for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<OutlinePose> poses;
  for (const Candidate& candidate : all) poses.push_back(pose_of(candidate, frames[candidate.frame]));
  return poses;
}

std::vector<OutlinePose> CoarseSearch::by_outline() const {
  const Window& window = evidence_.window(0);
  const std::vector<AtlasView> views = view_atlas(mesh_, outline_views, perspective_);
  std::vector<OutlinePose> poses;
  for (const ChamferMatch& match :
       chamfer_matches(mesh_, views, *evidence_.outline(), chamfer_matches_kept)) {
    const Eigen::Vector2d shift = window.to_photo(match.shift);
    poses.push_back(
        pose_of(views[match.view], match.angle, match.scale / window.px_per_photo_px, shift, shift));
  }
  return poses;
}

std::vector<OutlinePose> CoarseSearch::distinct(const std::vector<OutlinePose>& sorted, double apart_rad,
                                                std::size_t most) const {
  const SearchPlan plan = evidence_.plan();
  std::vector<OutlinePose> starts;
  for (const OutlinePose& pose : sorted) {
    if (starts.size() == most) break;
    if (settings_.allowed && !settings_.allowed(pose)) continue;
    const bool seen = std::any_of(starts.begin(), starts.end(), [&](const OutlinePose& better) {
      return angle_between(better.rotation, pose.rotation) < apart_rad &&
             (better.shift - pose.shift).norm() < plan.distinct_place * pose.scale &&
             std::abs(std::log(better.scale / pose.scale)) < plan.distinct_size;
    });
    if (seen) continue;
    const auto crowd = static_cast<std::size_t>(std::count_if(
        starts.begin(), starts.end(), [&](const OutlinePose& better) { return in_one_place(better, pose); }));
    if (crowd < plan.most_in_a_place) starts.push_back(pose);
  }
  return starts;
}

void drop_beaten(std::vector<RefinedPose>& sorted, double margin) {
  std::erase_if(sorted, [best = sorted.empty() ? 0.0 : sorted.front().agreement.score(),
                         margin](const RefinedPose& pose) { return pose.agreement.score() < best - margin; });
}

// Under a long lens a body with a plane of symmetry of normal n looks the same from D R (I - 2 n n^T), D =
// diag(1, 1, -1). The normals of such planes are principal axes.
std::vector<OutlinePose> with_mirror_twins(const std::vector<OutlinePose>& poses,
                                           const Eigen::Matrix3d& principal_axes) {
  std::vector<OutlinePose> all = poses;
  const Eigen::Matrix3d flip = Eigen::Vector3d(1, 1, -1).asDiagonal();
  for (const OutlinePose& pose : poses) {
    // About the ray to the body, not about the optical axis.
    const double focal = pose.scale / std::max(pose.perspective, 1e-6);
    const Eigen::Matrix3d off_axis =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(),
                                           Eigen::Vector3d(pose.shift.x(), pose.shift.y(), focal))
            .toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d n = principal_axes.col(axis);
      OutlinePose twin = pose;
      twin.rotation = off_axis * flip * off_axis.transpose() * pose.rotation *
                      (Eigen::Matrix3d::Identity() - 2 * n * n.transpose());
      all.push_back(twin);
    }
  }
  return all;
}

// Of the surface, by the faces' middles and areas.
Eigen::Matrix3d principal_axes_of(const OutlineMesh& mesh) {
  double total = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const Face& f : mesh.faces) {
    const Eigen::Vector3d& a = mesh.vertices[f[0]];
    const Eigen::Vector3d& b = mesh.vertices[f[1]];
    const Eigen::Vector3d& c = mesh.vertices[f[2]];
    const double area = (b - a).cross(c - a).norm() / 2;
    const Eigen::Vector3d middle = (a + b + c) / 3;
    total += area;
    sum += area * middle;
    squares += area * middle * middle.transpose();
  }
  if (!(total > 0)) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d mean = sum / total;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(squares / total - mean * mean.transpose())
      .eigenvectors();
}

// A cropped photo's principal point is not in its middle. It is freed only where that explains the outline
// far better, as all others are better off without two more unknowns.
RefinedPose with_free_principal_point(const OutlineMesh& mesh, const RefinedPose& fixed,
                                      const Evidence& evidence, const LensPrior& lens) {
  if (fixed.chi_squared < principal_point_gain) return fixed;  // nothing to gain
  OutlineDrawing drawing;
  const RefinementPlan plan{evidence.levels() - 1, 8, 3, 1.5, 1.0, true};
  const RefinedPose free = refine_pose(mesh, fixed.pose, evidence, lens, plan, drawing);
  const bool better = free.chi_squared < 0.35 * fixed.chi_squared &&
                      fixed.chi_squared - free.chi_squared > principal_point_gain &&
                      free.agreement.overlap > fixed.agreement.overlap;
  return better ? free : fixed;
}

}  // namespace

PoseSearchResult search_poses(const MeshLevels& meshes, const Evidence& evidence,
                              const SearchSettings& settings, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  PoseSearchResult result;
  const auto refined_all = [&](const OutlineMesh& mesh, const std::vector<OutlinePose>& starts,
                               const RefinementPlan& how) {
    return refine_poses(mesh, starts, evidence, settings.lens, how, progress);
  };
  const int last = evidence.levels() - 1;
  const SearchPlan plan = evidence.plan();
  const RefinementPlan glance{0, 5, plan.glance_reach_px, 6, 1.5, false};
  const RefinementPlan close_glance{0, 5, 8, 4, 1.5, false, true};
  const RefinementPlan coarse{0, 12, 8, 2, 1.0, false};
  const RefinementPlan middle{std::min(1, last), 8, 6, 2, 1.0, false};

  std::vector<RefinedPose> refined;
  if (!settings.starts.empty()) {
    refined = refined_all(meshes.coarse, settings.starts, coarse);
  } else {
    const CoarseSearch search(meshes, evidence, settings);
    progress.update(0.2, "comparing views");
    for (int effort = 0; effort < 2; ++effort) {
      const std::vector<OutlinePose> starts =
          search.starts(effort, effort == 0 ? plan.candidates : plan.candidates_with_effort);
      result.statistics.candidates_listed = static_cast<int>(search.listed(effort));
      result.statistics.candidates_tried += static_cast<int>(starts.size());
      std::vector<RefinedPose> glanced =
          distinct_poses(refined_all(meshes.coarse, starts, effort == 0 ? glance : close_glance),
                         effort == 0 ? plan.kept_after_glance : plan.kept_with_effort);
      if (effort == 0) drop_beaten(glanced, plan.glance_margin);
      progress.update(effort == 0 ? 0.4 : 0.6, "refining");
      std::vector<RefinedPose> settled = refined_all(meshes.coarse, poses_of(glanced), coarse);
      progress.update(effort == 0 ? 0.5 : 0.7, "refining");
      refined.insert(refined.end(), settled.begin(), settled.end());
      refined = distinct_poses(std::move(refined), plan.kept_with_effort);
      if (!refined.empty() && refined.front().agreement.explained() > plan.good_score) break;
    }
  }
  result.statistics.coarse_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (settings.starts.empty()) {
    refined = distinct_poses(std::move(refined), plan.kept_for_middle);
    drop_beaten(refined, plan.coarse_margin);
    const std::vector<OutlinePose> twins =
        with_mirror_twins(poses_of(distinct_poses(refined, 2)), principal_axes_of(meshes.coarse));
    std::vector<RefinedPose> more = refined_all(meshes.coarse, twins, coarse);
    refined.insert(refined.end(), more.begin(), more.end());
    if (settings.allowed)
      std::erase_if(refined, [&](const RefinedPose& r) { return !settings.allowed(r.pose); });
  }
  refined = distinct_poses(std::move(refined), plan.kept_for_middle);
  drop_beaten(refined, plan.coarse_margin);
  progress.update(0.75, "refining");
  refined = distinct_poses(refined_all(meshes.middle, poses_of(refined), middle), plan.kept_for_full);
  drop_beaten(refined, plan.middle_margin);
  progress.update(0.85, "refining");
  for (int level = std::min(2, last); level <= last; ++level) {
    const RefinementPlan fine{level, 8, 5, 1.5, 1.0, false};
    refined = distinct_poses(refined_all(meshes.full, poses_of(refined), fine), plan.kept_for_full);
  }
  if (!refined.empty() && !settings.principal_point_known && !settings.lens.orthographic)
    refined.front() = with_free_principal_point(meshes.full, refined.front(), evidence, settings.lens);
  progress.update(1, "refining");
  result.poses = std::move(refined);
  return result;
}

}  // namespace drape::alignment
