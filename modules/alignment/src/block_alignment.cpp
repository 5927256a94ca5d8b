#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "block_pose.hpp"
#include "drape/alignment/align_block.hpp"
#include "drape/base/error.hpp"
#include "noisy_outline.hpp"
#include "outline_figures.hpp"
#include "photo_plane.hpp"
#include "pose_search.hpp"
#include "pose_verdict.hpp"
#include "simplified_mesh.hpp"
#include "stencil_evidence.hpp"
#include "verdict_limits.hpp"

namespace drape::alignment {
namespace {

constexpr double degrees = 180 / std::numbers::pi;
constexpr double agreement_rad = 12 / degrees;  // of two photos' candidates: no more, and they contradict
constexpr double distinct_rad = 10 / degrees;
constexpr std::size_t kept_after_glance = 6;
constexpr double smooth_share = 0.006;  // of the object: an outline's noise with which less of it has to fit
constexpr int coarse_faces = 1500;
constexpr int middle_faces = 8000;

/// One photo of the block with what does not change.
struct Shot {
  Shot(const BlockPhoto& given)
      : camera_from_block(given.camera_from_block),
        width(given.evidence.stencil.width()),
        height(given.evidence.stencil.height()),
        object_px(object_extent(given.evidence.stencil)),
        plane(width, height, given.evidence.lens),
        outline(given.evidence.stencil, plane) {
    const double focal =
        plane.focal_px().value_or(std::sqrt(given.evidence.lens->K(0, 0) * given.evidence.lens->K(1, 1)));
    ideal_K << focal, 0, plane.principal_px().x(), 0, focal, plane.principal_px().y(), 0, 0, 1;
    lens.fixed_focal_px = focal;
    lens.photo_width_px = width;
  }

  Rigid3 camera_from_block;
  int width;
  int height;
  double object_px;
  PhotoPlane plane;
  StencilEvidence outline;
  Eigen::Matrix3d ideal_K = Eigen::Matrix3d::Identity();
  LensPrior lens;

  /// This one, or the finest that there is.
  [[nodiscard]] int level(int wanted) const { return std::min(wanted, outline.levels() - 1); }
};

struct Fit {
  Similarity block_from_world;
  std::vector<Agreement> agreements;  // one per photo; all 0 where the mesh is not before the camera

  /// The mean over the photos.
  [[nodiscard]] double score() const {
    double sum = 0;
    for (const Agreement& agreement : agreements) sum += agreement.score();
    return sum / static_cast<double>(std::max<std::size_t>(1, agreements.size()));
  }
};

struct Plan {
  const OutlineMesh* mesh;
  int level;
  int rounds;
  double reach_px;
  double inlier_px;
};

class BlockRefinement {
 public:
  BlockRefinement(const std::vector<Shot>& shots, const UnitSphere& sphere)
      : shots_(shots), sphere_(sphere) {}

  [[nodiscard]] std::optional<OutlinePose> pose_in(const Shot& shot, const Similarity& similarity) const {
    Camera camera;
    camera.width = shot.width;
    camera.height = shot.height;
    camera.K = shot.ideal_K;
    camera.camera_from_world = camera_from_world(shot.camera_from_block, similarity);
    return pose_of(camera, sphere_, shot.plane.principal_px());
  }

  [[nodiscard]] Fit fit(const Similarity& similarity, const Plan& plan);

  /// Of one photo at its last level.
  [[nodiscard]] Agreement agreement(const Shot& shot, const OutlinePose& pose, const OutlineMesh& mesh,
                                    double inlier_px);

  /// Gauss-Newton on all photos: each is refined a little by itself; the similarity follows them, by the
  /// information that each photo has about its pose.
  [[nodiscard]] Fit refined(const Similarity& start, const Plan& plan);

 private:
  using PoseDerivative = Eigen::Matrix<double, pose_parameters, similarity_parameters>;

  [[nodiscard]] std::optional<PoseDerivative> derivative(const Shot& shot, const Similarity& similarity,
                                                         const OutlinePose& pose) const;

  const std::vector<Shot>& shots_;
  const UnitSphere& sphere_;
  OutlineDrawing drawing_;
  std::vector<RimResidual> residuals_;
};

/// What has to be done to `from` for it to become `to`.
PoseVector difference(const OutlinePose& from, const OutlinePose& to) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(to.rotation * from.rotation.transpose()));
  PoseVector d = PoseVector::Zero();
  d.head<3>() = turn.angle() * turn.axis();
  d[3] = to.scale - from.scale;
  d.segment<2>(4) = to.shift - from.shift;
  d[6] = to.perspective - from.perspective;
  return d;
}

Fit BlockRefinement::fit(const Similarity& similarity, const Plan& plan) {
  Fit result{similarity, std::vector<Agreement>(shots_.size())};
  for (std::size_t i = 0; i < shots_.size(); ++i) {
    const auto pose = pose_in(shots_[i], similarity);
    if (!pose) continue;
    const int level = shots_[i].level(plan.level);
    drawing_.draw(*plan.mesh, *pose, shots_[i].outline.window(level));
    result.agreements[i] =
        shots_[i].outline.match(drawing_, level, plan.reach_px, plan.inlier_px, residuals_);
  }
  return result;
}

Agreement BlockRefinement::agreement(const Shot& shot, const OutlinePose& pose, const OutlineMesh& mesh,
                                     double inlier_px) {
  const int last = shot.outline.levels() - 1;
  drawing_.draw(mesh, pose, shot.outline.window(last));
  return shot.outline.match(drawing_, last, most_noise_reach_px, inlier_px, residuals_);
}

std::optional<BlockRefinement::PoseDerivative> BlockRefinement::derivative(const Shot& shot,
                                                                           const Similarity& similarity,
                                                                           const OutlinePose& pose) const {
  PoseDerivative d;
  for (int k = 0; k < similarity_parameters; ++k) {
    SimilarityVector step = SimilarityVector::Zero();
    step[k] = 1e-6 * (k < 4 ? 1 : similarity.scale * sphere_.radius);
    const auto after = pose_in(shot, moved(similarity, step, sphere_.center));
    if (!after) return std::nullopt;
    d.col(k) = difference(pose, *after) / step[k];
  }
  return d;
}

Fit BlockRefinement::refined(const Similarity& start, const Plan& plan) {
  Fit best = fit(start, plan);
  Similarity similarity = start;
  using Normal = Eigen::Matrix<double, similarity_parameters, similarity_parameters>;
  for (int round = 0; round < plan.rounds; ++round) {
    Normal matrix = Normal::Zero();
    SimilarityVector vector = SimilarityVector::Zero();
    const double reach = std::max(2.0, plan.reach_px * std::pow(0.6, round));
    for (const Shot& shot : shots_) {
      const auto pose = pose_in(shot, similarity);
      if (!pose) continue;
      const auto d = derivative(shot, similarity, *pose);
      if (!d) continue;
      const RefinementPlan alone{shot.level(plan.level), 3,    reach, std::max(2.0, 0.7 * reach),
                                 plan.inlier_px,         false};
      const RefinedPose own = refine_pose(*plan.mesh, *pose, shot.outline, shot.lens, alone, drawing_);
      // A photo whose stencil does not fit at all is not to pull the others away.
      const double trust = std::pow(own.agreement.score(), 4);
      matrix += trust * d->transpose() * own.information * *d;
      vector += trust * d->transpose() * own.information * difference(*pose, own.pose);
    }
    matrix.diagonal() *= 1 + 1e-6;
    const SimilarityVector step = matrix.ldlt().solve(vector);
    if (!step.allFinite()) break;
    similarity = moved(similarity, step, sphere_.center);
    const Fit now = fit(similarity, plan);
    if (now.score() > best.score()) best = now;
  }
  return best;
}

void check(const std::vector<BlockPhoto>& photos, const AlignOptions& options) {
  if (photos.size() < 2)
    throw config_error("a block has two photos at least; this one has {}", photos.size());
  if (options.projection != Camera::Projection::perspective)
    throw config_error("align.block needs align.projection: perspective");
  if (std::any_of(photos.begin(), photos.end(), [](const BlockPhoto& p) { return !p.evidence.lens; }))
    throw config_error("a photo of the block has no lens");
  double spread = 0;
  double size = 0;
  const Eigen::Vector3d first = photos.front().camera_from_block.inverse().translation();
  for (const BlockPhoto& photo : photos) {
    const Eigen::Vector3d center = photo.camera_from_block.inverse().translation();
    spread = std::max(spread, (center - first).norm());
    size = std::max(size, center.norm());
  }
  if (!(spread > 1e-9 * size))
    throw config_error("the block's cameras all stand in one place: that tells nothing of its scale");
}

// Every agreement of two photos' candidates, the best fitting first, without doubles.
std::vector<Fit> hypotheses(const std::vector<BlockPhoto>& photos, const std::vector<Alignment>& alone,
                            BlockRefinement& refinement, const Plan& glance) {
  std::vector<Fit> fits;
  for (std::size_t i = 0; i < photos.size(); ++i)
    for (std::size_t j = i + 1; j < photos.size(); ++j)
      for (const AlignmentCandidate& a : alone[i].candidates)
        for (const AlignmentCandidate& b : alone[j].candidates) {
          const auto opinion = pair_opinion(photos[i].camera_from_block, a.camera.camera_from_world,
                                            photos[j].camera_from_block, b.camera.camera_from_world);
          if (!opinion || opinion->disagreement_rad > agreement_rad) continue;
          fits.push_back(refinement.fit(opinion->block_from_world, glance));
        }
  std::stable_sort(fits.begin(), fits.end(),
                   [](const Fit& a, const Fit& b) { return a.score() > b.score(); });
  return fits;
}

void keep_distinct(std::vector<Fit>& fits, std::size_t most) {
  std::stable_sort(fits.begin(), fits.end(),
                   [](const Fit& a, const Fit& b) { return a.score() > b.score(); });
  std::vector<Fit> kept;
  for (Fit& fit : fits) {
    if (kept.size() == most) break;
    const bool seen = std::any_of(kept.begin(), kept.end(), [&](const Fit& better) {
      return angle_between(better.block_from_world.rotation, fit.block_from_world.rotation) < distinct_rad;
    });
    if (!seen) kept.push_back(std::move(fit));
  }
  fits = std::move(kept);
}

double inliers(const Agreement& agreement) {
  return std::min(agreement.rim_inliers, agreement.image_inliers);
}

// How rough each photo's outline is about the best fit, and how well the fits are with that allowed for.
std::vector<OutlineFigures> allow_for_noise(std::vector<Fit>& fits, const std::vector<Shot>& shots,
                                            const OutlineMesh& mesh, BlockRefinement& refinement) {
  std::vector<OutlineFigures> figures(shots.size());
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const Shot& shot = shots[i];
    const int last = shot.outline.levels() - 1;
    const auto best = refinement.pose_in(shot, fits.front().block_from_world);
    if (!best) continue;
    const OutlineNoise noise = noise_about(mesh, *best, shot.outline, last);
    figures[i] = outline_figures(mesh, *best, shot.outline, noise, shot.object_px);
    for (Fit& fit : fits)
      if (const auto pose = refinement.pose_in(shot, fit.block_from_world))
        fit.agreements[i] = refinement.agreement(shot, *pose, mesh, inlier_px(noise));
  }
  return figures;
}

// Most of the photos have to fit. That the outlines of several photos are alike by chance, all in one place
// of the mesh, is the less likely the more there are: less of each has to fit than of a photo alone, and the
// margin over the next place may be less, as each photo has noise of its own.
void judge(const std::vector<Fit>& fits, const std::vector<OutlineFigures>& figures, BlockAlignment& block) {
  const auto count = static_cast<double>(figures.size());
  const double enough = least_inliers + (good_inliers - least_inliers) / std::sqrt(count);
  int other = 0;
  std::vector<std::string> doubts;
  double margin = 0;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const double share = inliers(fits.front().agreements[i]);
    other += share < least_inliers;
    // What is off by more all along would let much of any outline fit.
    const bool smooth = figures[i].noise_px < smooth_share * figures[i].object_px;
    const OutlineDoubts of_photo = outline_doubts(share, figures[i], smooth ? enough : good_inliers);
    if (!of_photo.reasons.empty()) doubts.push_back(of_photo.reasons.front());
    margin += (needed_margin(figures[i]) - least_margin) / count;
  }
  if (2 * other >= static_cast<int>(figures.size())) {
    block.reasons.push_back(fmt::format(
        "of {} of {} photos most of the outline does not fit: is it another object?", other, figures.size()));
    return;
  }
  block.verdict = Verdict::accept;
  const auto doubt = [&](std::string reason) {
    block.verdict = Verdict::review;
    block.reasons.push_back(std::move(reason));
  };
  if (2 * doubts.size() >= figures.size())
    doubt(fmt::format("{} of {} photos do not fit well: {}", doubts.size(), figures.size(), doubts.front()));
  if (fits.size() > 1 && fits[0].score() - fits[1].score() < least_margin + margin / std::sqrt(count))
    doubt(fmt::format(
        "the block turned by {:.0f} degrees fits nearly as well",
        angle_between(fits[0].block_from_world.rotation, fits[1].block_from_world.rotation) * degrees));
  if (block.reasons.empty())
    block.reasons.push_back(
        fmt::format("{} of {} photos fit together", figures.size() - doubts.size(), figures.size()));
}

Alignment photo_of_block(const Shot& shot, const UnitSphere& sphere, std::size_t index,
                         const std::vector<Fit>& fits, const BlockRefinement& refinement,
                         const BlockAlignment& block) {
  Alignment photo;
  photo.verdict = block.verdict;
  photo.reasons = block.reasons;
  for (const Fit& fit : fits) {
    const auto pose = refinement.pose_in(shot, fit.block_from_world);
    if (!pose) continue;
    const Agreement& agreement = fit.agreements[index];
    photo.candidates.push_back({camera_of(*pose, sphere, Camera::Projection::perspective,
                                          shot.plane.principal_px(), shot.width, shot.height),
                                100 * agreement.overlap, fit.score(),
                                &fit == &fits.front() ? block.verdict : Verdict::reject});
  }
  if (photo.candidates.empty()) return photo;
  const Agreement& best = fits.front().agreements[index];
  photo.camera = photo.candidates.front().camera;
  photo.overlap_percent = 100 * best.overlap;
  photo.inlier_fraction = 0.5 * (best.rim_inliers + best.image_inliers);
  if (photo.inlier_fraction > 0) photo.boundary_error_px = best.rms_px;
  if (block.verdict != Verdict::reject && inliers(best) < least_inliers)
    photo.reasons.push_back(fmt::format("of this photo's outline only {:.0f} % fits", 100 * inliers(best)));
  return photo;
}

MeshLevels mesh_levels(const TriangleMesh& mesh, const UnitSphere& sphere) {
  const TriangleMesh middle = simplified_mesh(mesh, middle_faces);
  return {outline_mesh(simplified_mesh(middle, coarse_faces), sphere), outline_mesh(middle, sphere),
          outline_mesh(mesh, sphere)};
}

}  // namespace

BlockAlignment align_block(const TriangleMesh& mesh, const std::vector<BlockPhoto>& photos,
                           const AlignOptions& options, std::uint64_t seed, const Progress& progress) {
  check(photos, options);
  BlockAlignment block;
  std::vector<Alignment> alone;
  const auto count = static_cast<double>(photos.size());
  for (const BlockPhoto& photo : photos) {
    const auto done = static_cast<double>(alone.size());
    alone.push_back(align_photo(mesh, photo.evidence, options, seed,
                                progress.part(0.7 * done / count, 0.7 * (done + 1) / count)));
  }
  const UnitSphere sphere = unit_sphere(mesh);
  const MeshLevels meshes = mesh_levels(mesh, sphere);
  std::vector<Shot> shots(photos.begin(), photos.end());
  BlockRefinement refinement(shots, sphere);
  int finest = 0;
  for (const Shot& shot : shots) finest = std::max(finest, shot.outline.levels() - 1);

  progress.update(0.7, "fitting the block");
  std::vector<Fit> fits = hypotheses(photos, alone, refinement, {&meshes.coarse, 0, 0, 16, 4});
  keep_distinct(fits, kept_after_glance);
  const std::vector<Plan> plans = {{&meshes.coarse, 0, 6, 16, 2},
                                   {&meshes.coarse, 0, 4, 6, 1},
                                   {&meshes.middle, 1, 4, 6, 1},
                                   {&meshes.full, finest, 5, 5, 1}};
  for (std::size_t p = 0; p < plans.size(); ++p) {
    for (Fit& fit : fits) fit = refinement.refined(fit.block_from_world, plans[p]);
    keep_distinct(fits, p + 1 < plans.size() ? kept_after_glance - 2 * p : 2);
    progress.update(0.75 + 0.06 * static_cast<double>(p), "fitting the block");
  }
  if (fits.empty()) {
    block.reasons = {"no two photos agree on a pose of the mesh"};
    block.photos = std::move(alone);
    for (Alignment& photo : block.photos) {
      photo.verdict = Verdict::reject;
      photo.reasons = block.reasons;
    }
    return block;
  }
  const std::vector<OutlineFigures> figures = allow_for_noise(fits, shots, meshes.full, refinement);
  judge(fits, figures, block);
  block.block_from_world = fits.front().block_from_world;
  for (std::size_t i = 0; i < shots.size(); ++i) {
    block.photos.push_back(photo_of_block(shots[i], sphere, i, fits, refinement, block));
    block.photos.back().outline = figures[i];
  }
  progress.update(1, "fitting the block");
  return block;
}

}  // namespace drape::alignment
