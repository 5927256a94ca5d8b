#include "rough_outline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drape/base/parallel.hpp"
#include "pixel_fit.hpp"
#include "shading_refinement.hpp"

namespace drape::alignment {
namespace {

constexpr double rough_px = 0.4;  // deviations of an outline: with less the pixel grid is what is seen
constexpr double margin_deviations = 2;

// Errors over the deviations that residuals alone tell, root mean square over simulated photos. Distances to
// the nearest point are less than those that made the noise; light that no harmonics describe pulls all of
// the inside the same way; and a pose that meets the pixels is better than half pixels let expect.
constexpr double outline_spread = 1.5;
constexpr double inside_spread = 2.1;
constexpr double pixel_spread = 0.35;
constexpr double pixel_margin = 0.05;     // of the score, within which the pixels are asked
constexpr double overlap_weight = 2;      // of what they say, beside the score
constexpr double contender_margin = 0.1;  // of the score: with less the inside is not asked
constexpr double score_per_likelihood = 1.0 / 150;
constexpr double most_loss = 0.3;

struct Settled {
  RefinedPose pose;
  bool by_photo = false;
  std::optional<double> likelihood;  // logarithm, of the inside
  std::optional<ShadingFit> inside;
};

double gain_of(const ShadedPose& shaded, const RefinedPose& by_outline) {
  const double inside = shaded.before.independent * std::log(shaded.before.sigma / shaded.after.sigma);
  return inside - (shaded.refined.chi_squared - by_outline.chi_squared) / 2;
}

std::vector<InsideOfPhoto> insides_of(const PhotoInside& photo, const StencilEvidence& evidence,
                                      double sigma_px) {
  std::vector<InsideOfPhoto> insides;
  const double finest = evidence.window(evidence.levels() - 1).px_per_photo_px;
  for (int level = 0; level < std::min(2, evidence.levels()); ++level) {
    const double sigma = sigma_px / finest * evidence.window(level).px_per_photo_px;
    insides.push_back(
        inside_of_photo(photo.rgb, photo.plane, evidence.at(level), 1 + margin_deviations * sigma));
  }
  return insides;
}

void ask_inside(NoisyOutline& outline, const LitMesh& mesh, const std::vector<InsideOfPhoto>& insides,
                Settled& one) {
  const auto shaded = pose_by_shading(outline, mesh, insides, one.pose);
  if (!shaded) return;
  one.likelihood = shaded->before.log_likelihood();
  one.inside = shaded->before;
  if (!(gain_of(*shaded, one.pose) > 0)) return;
  // As if both fits had as many samples of their own: those are of the photo, not of the pose.
  one.likelihood = -shaded->before.independent * std::log(shaded->after.sigma);
  one.inside = shaded->after;
  one.pose = shaded->refined;
  one.by_photo = true;
}

// The less likely the inside, the less a pose's score.
void rank_by_inside(std::vector<Settled>& settled) {
  std::optional<double> best;
  for (const Settled& one : settled)
    if (one.likelihood) best = std::max(*one.likelihood, best.value_or(*one.likelihood));
  for (Settled& one : settled) {
    if (!one.likelihood) continue;
    const double loss = std::min(most_loss, score_per_likelihood * (*best - *one.likelihood));
    one.pose.agreement.ranking = one.pose.agreement.score() - loss;
  }
}

// The best pose and what scores nearly as well. Between these the pixels decide: of a clean stencil the right
// pose meets nearly all of them. Not so of an open mesh, whose holes cover whatever they lie before.
std::vector<RefinedPose> fitted_to_pixels(const std::vector<RefinedPose>& poses, const OutlineMesh& mesh,
                                          const StencilEvidence& evidence, const LensPrior& lens) {
  std::vector<RefinedPose> fitted = poses;
  const double best = poses.front().agreement.score();
  const auto end = std::find_if(fitted.begin(), fitted.end(), [&](const RefinedPose& pose) {
    return pose.agreement.score() < best - pixel_margin;
  });
  parallel_for(static_cast<std::size_t>(end - fitted.begin()), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      fitted[i] = fit_to_pixels(mesh, fitted[i], evidence, lens);
      fitted[i].spread = pixel_spread;
    }
  });
  double most = 0;
  for (auto pose = fitted.begin(); pose != end; ++pose) most = std::max(most, pose->agreement.overlap);
  for (auto pose = fitted.begin(); pose != end && !mesh.open; ++pose)
    pose->agreement.ranking = pose->agreement.score() - overlap_weight * (most - pose->agreement.overlap);
  std::stable_sort(fitted.begin(), fitted.end(), [](const RefinedPose& a, const RefinedPose& b) {
    return a.agreement.score() > b.agreement.score();
  });
  return fitted;
}

}  // namespace

SettledPoses settled_poses(const std::vector<RefinedPose>& poses, const OutlineMesh& mesh,
                           const StencilEvidence& evidence, const LensPrior& lens,
                           const std::optional<PhotoInside>& photo, const Progress& progress) {
  SettledPoses result{poses, grid_noise};
  if (poses.empty()) return result;
  const int last = evidence.levels() - 1;
  result.noise = noise_about(mesh, poses.front().pose, evidence, last);
  if (result.noise.sigma_px < rough_px) {
    result.smooth = true;
    result.poses = fitted_to_pixels(poses, mesh, evidence, lens);
    return result;
  }
  std::optional<LitMesh> lit;
  std::vector<InsideOfPhoto> insides;
  if (photo) {
    lit = lit_mesh(mesh, photo->colors);
    insides = insides_of(*photo, evidence, result.noise.sigma_px);
  }
  std::vector<Settled> settled(poses.size());
  const auto each_pose = [&](auto work) {
    parallel_for(poses.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (progress.stop_requested()) return;
        NoisyOutline outline(mesh, evidence, lens, last, result.noise);
        work(outline, i);
      }
    });
  };
  each_pose(
      [&](NoisyOutline& outline, std::size_t i) { settled[i].pose = settled_pose(outline, poses[i].pose); });
  if (lit) {
    double best = 0;
    for (const Settled& one : settled) best = std::max(best, one.pose.agreement.score());
    each_pose([&](NoisyOutline& outline, std::size_t i) {
      if (settled[i].pose.agreement.score() > best - contender_margin)
        ask_inside(outline, *lit, insides, settled[i]);
    });
    rank_by_inside(settled);
  }
  std::stable_sort(settled.begin(), settled.end(), [](const Settled& a, const Settled& b) {
    return a.pose.agreement.score() > b.pose.agreement.score();
  });
  result.poses.clear();
  for (Settled& one : settled) {
    one.pose.spread = one.by_photo ? inside_spread : outline_spread;
    result.poses.push_back(std::move(one.pose));
  }
  result.shaded = settled.front().by_photo;
  result.inside = settled.front().inside;
  return result;
}

}  // namespace drape::alignment
