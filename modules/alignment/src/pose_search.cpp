#include "pose_search.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "coarse_search.hpp"
#include "distinct_poses.hpp"

namespace drape::alignment {
namespace {

constexpr double principal_point_gain = 200;  // of chi squared

void drop_beaten(std::vector<RefinedPose>& sorted, double margin) {
  std::erase_if(sorted, [best = sorted.empty() ? 0.0 : sorted.front().agreement.score(),
                         margin](const RefinedPose& pose) { return pose.agreement.score() < best - margin; });
}

// The best distinct ones, at most so many, and so many of one place.
std::vector<RefinedPose> best_of(std::vector<RefinedPose> poses, std::size_t most,
                                 std::size_t most_in_a_place) {
  if (most_in_a_place >= poses.size()) return distinct_poses(std::move(poses), most);
  const std::size_t count = poses.size();
  std::vector<RefinedPose> kept;
  for (RefinedPose& pose : distinct_poses(std::move(poses), count)) {
    if (kept.size() == most) break;
    const auto crowd = std::count_if(kept.begin(), kept.end(), [&](const RefinedPose& better) {
      return in_one_place(better.pose, pose.pose);
    });
    if (static_cast<std::size_t>(crowd) < most_in_a_place) kept.push_back(std::move(pose));
  }
  return kept;
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

class PoseSearch {
 public:
  PoseSearch(const MeshLevels& meshes, const Evidence& evidence, const SearchSettings& settings,
             const Progress& progress)
      : meshes_(meshes),
        evidence_(evidence),
        settings_(settings),
        progress_(progress),
        plan_(evidence.plan()),
        last_(evidence.levels() - 1) {}

  [[nodiscard]] PoseSearchResult run() {
    const auto begin = std::chrono::steady_clock::now();
    const bool anywhere = settings_.starts.empty();
    std::vector<RefinedPose> poses =
        anywhere ? from_all_views() : refined(meshes_.coarse, settings_.starts, coarse_);
    result_.statistics.coarse_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (anywhere) add_mirror_twins(poses);
    result_.poses = on_full_mesh(std::move(poses));
    progress_.update(1, "refining");
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::vector<RefinedPose> refined(const OutlineMesh& mesh,
                                                 const std::vector<OutlinePose>& starts,
                                                 const RefinementPlan& how) const {
    return refine_poses(mesh, starts, evidence_, settings_.lens, how, progress_);
  }
  [[nodiscard]] std::vector<RefinedPose> from_all_views();
  [[nodiscard]] std::vector<RefinedPose> glanced(const CoarseSearch& search);
  [[nodiscard]] std::vector<RefinedPose> glanced_with_effort(const CoarseSearch& search);
  void add_mirror_twins(std::vector<RefinedPose>& poses) const;
  [[nodiscard]] std::vector<RefinedPose> on_full_mesh(std::vector<RefinedPose> poses) const;

  const MeshLevels& meshes_;
  const Evidence& evidence_;
  const SearchSettings& settings_;
  const Progress& progress_;
  const SearchPlan plan_;
  const int last_;
  const RefinementPlan coarse_{0, 12, 8, 2, 1.0, false};
  PoseSearchResult result_;
};

std::vector<RefinedPose> PoseSearch::from_all_views() {
  const CoarseSearch search(meshes_.coarse, evidence_, settings_.lens, settings_.allowed);
  progress_.update(0.2, "comparing views");
  std::vector<RefinedPose> poses;
  for (int effort = 0; effort < 2; ++effort) {
    const std::vector<RefinedPose> starts = effort == 0 ? glanced(search) : glanced_with_effort(search);
    result_.statistics.candidates_listed = static_cast<int>(search.listed(effort));
    progress_.update(effort == 0 ? 0.4 : 0.6, "refining");
    const std::vector<RefinedPose> settled = refined(meshes_.coarse, poses_of(starts), coarse_);
    progress_.update(effort == 0 ? 0.5 : 0.7, "refining");
    poses.insert(poses.end(), settled.begin(), settled.end());
    poses = distinct_poses(std::move(poses), plan_.kept_with_effort);
    if (!poses.empty() && poses.front().agreement.explained() > plan_.good_score) break;
  }
  return poses;
}

// What a few steps make of the starting poses, and of more about the places that they lead to.
std::vector<RefinedPose> PoseSearch::glanced(const CoarseSearch& search) {
  const RefinementPlan glance{0, 5, plan_.glance_reach_px, 6, 1.5, false};
  const std::vector<OutlinePose> starts = search.starts(0, plan_.candidates);
  result_.statistics.candidates_tried += static_cast<int>(starts.size());
  std::vector<RefinedPose> poses = refined(meshes_.coarse, starts, glance);
  if (plan_.places > 0) {
    const std::vector<OutlinePose> more =
        search.starts_about(poses_of(best_of(poses, plan_.places, 1)), plan_.candidates_of_a_size);
    result_.statistics.candidates_tried += static_cast<int>(more.size());
    const std::vector<RefinedPose> closer = refined(meshes_.coarse, more, glance);
    poses.insert(poses.end(), closer.begin(), closer.end());
  }
  poses = best_of(std::move(poses), plan_.kept_after_glance, plan_.glanced_in_a_place);
  drop_beaten(poses, plan_.glance_margin);
  return poses;
}

std::vector<RefinedPose> PoseSearch::glanced_with_effort(const CoarseSearch& search) {
  const RefinementPlan close_glance{0, 5, 8, 4, 1.5, false, true};
  const std::vector<OutlinePose> starts = search.starts(1, plan_.candidates_with_effort);
  result_.statistics.candidates_tried += static_cast<int>(starts.size());
  return distinct_poses(refined(meshes_.coarse, starts, close_glance), plan_.kept_with_effort);
}

void PoseSearch::add_mirror_twins(std::vector<RefinedPose>& poses) const {
  const std::vector<OutlinePose> twins =
      with_mirror_twins(poses_of(distinct_poses(poses, 2)), principal_axes_of(meshes_.coarse));
  poses = best_of(std::move(poses), plan_.kept_for_middle, plan_.middle_in_a_place);
  drop_beaten(poses, plan_.coarse_margin);
  const std::vector<RefinedPose> more = refined(meshes_.coarse, twins, coarse_);
  poses.insert(poses.end(), more.begin(), more.end());
  if (settings_.allowed)
    std::erase_if(poses, [&](const RefinedPose& r) { return !settings_.allowed(r.pose); });
}

std::vector<RefinedPose> PoseSearch::on_full_mesh(std::vector<RefinedPose> poses) const {
  const RefinementPlan middle{std::min(1, last_), 8, 6, 2, 1.0, false};
  poses = best_of(std::move(poses), plan_.kept_for_middle, plan_.middle_in_a_place);
  drop_beaten(poses, plan_.coarse_margin);
  progress_.update(0.75, "refining");
  poses = best_of(refined(meshes_.middle, poses_of(poses), middle), plan_.kept_for_full,
                  plan_.finalists_in_a_place);
  drop_beaten(poses, plan_.middle_margin);
  progress_.update(0.85, "refining");
  for (int level = std::min(2, last_); level <= last_; ++level) {
    const RefinementPlan fine{level, 8, 5, 1.5, 1.0, false};
    poses = distinct_poses(refined(meshes_.full, poses_of(poses), fine), plan_.kept_for_full);
  }
  if (!poses.empty() && !settings_.principal_point_known && !settings_.lens.orthographic)
    poses.front() = with_free_principal_point(meshes_.full, poses.front(), evidence_, settings_.lens);
  return poses;
}

}  // namespace

PoseSearchResult search_poses(const MeshLevels& meshes, const Evidence& evidence,
                              const SearchSettings& settings, const Progress& progress) {
  return PoseSearch(meshes, evidence, settings, progress).run();
}

}  // namespace drape::alignment
