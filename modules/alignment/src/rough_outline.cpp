#include "rough_outline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drape/base/parallel.hpp"
#include "pixel_fit.hpp"
#include "shading_refinement.hpp"
#include "verdict_limits.hpp"

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
constexpr double pixel_margin = 0.05;         // of the score, within which the pixels are asked
constexpr double overlap_weight = 2;          // of what they say, beside the score
constexpr double contender_margin = 0.1;      // of the score: with less the inside is not asked
constexpr OutlineNoise leading_noise{1, 10};  // of a smooth outline while the inside leads
constexpr double score_per_likelihood = 1.0 / 150;
constexpr double most_loss = 0.3;
constexpr double undecided_margin = 0.9 * least_margin;

struct Settled {
  RefinedPose pose = {};
  bool by_photo = false;
  std::optional<ShadingFit> inside = std::nullopt;
};

// Of log likelihood, inside and outline together.
double gain_of(const ShadedPose& shaded) {
  const double inside = shaded.before.independent * std::log(shaded.before.sigma / shaded.after.sigma);
  return inside - (shaded.refined.chi_squared - shaded.chi_squared_before) / 2;
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
  one.inside = shaded->before;
  if (!(gain_of(*shaded) > 0)) return;
  one.inside = shaded->after;
  one.pose = shaded->refined;
  one.pose.spread = inside_spread;
  one.by_photo = true;
}

// The less likely the inside, the less a pose's score. Where light explains little of it, paint and shadows
// may speak for a wrong pose as well: then it gives their order, and they stay rivals.
void rank_by_inside(std::vector<Settled>& settled) {
  const Settled* best = nullptr;
  for (const Settled& one : settled)
    if (one.inside && (best == nullptr || one.inside->rms < best->inside->rms)) best = &one;
  if (best == nullptr) return;
  const ShadingFit inside = *best->inside;
  double most = 0;
  for (const Settled& one : settled) most = std::max(most, one.pose.agreement.score());
  for (Settled& one : settled) {
    if (!one.inside) continue;
    // How many samples there are is of the photo: only the right pose leaves them all to themselves.
    const double unlikely = inside.independent * std::log(one.inside->rms / inside.rms);
    const double score = one.pose.agreement.score();
    double ranking = score - std::min(most_loss, score_per_likelihood * unlikely);
    if (inside.explained < light_explains && score > most - least_margin)
      ranking = std::max(ranking, most - undecided_margin);
    one.pose.agreement.ranking = ranking;
  }
}

void sort_by_score(std::vector<Settled>& settled) {
  std::stable_sort(settled.begin(), settled.end(), [](const Settled& a, const Settled& b) {
    return a.pose.agreement.score() > b.pose.agreement.score();
  });
}

std::size_t contenders(const std::vector<Settled>& sorted, double margin) {
  const double best = sorted.front().pose.agreement.score();
  const auto end = std::find_if(sorted.begin(), sorted.end(), [&](const Settled& one) {
    return one.pose.agreement.score() < best - margin;
  });
  return static_cast<std::size_t>(end - sorted.begin());
}

// Each pose by itself, as the outline and the photo's inside tell.
class Settlement {
 public:
  Settlement(const OutlineMesh& mesh, const StencilEvidence& evidence, const LensPrior& lens,
             const OutlineNoise& noise, const Progress& progress)
      : mesh_(mesh), evidence_(evidence), lens_(lens), noise_(noise), progress_(progress) {}

  /// Sorted, with weights that fit the noise.
  [[nodiscard]] std::vector<Settled> by_outline(const std::vector<RefinedPose>& poses) const {
    std::vector<Settled> settled(poses.size());
    each(poses.size(), [&](std::size_t i) {
      NoisyOutline outline = noisy_outline();
      settled[i].pose = settled_pose(outline, poses[i].pose);
      settled[i].pose.spread = outline_spread;
    });
    sort_by_score(settled);
    return settled;
  }

  /// Sorted. The best and what scores nearly as well are fitted to the pixels, and these decide between them:
  /// of a clean stencil the right pose meets nearly all. Not so of an open mesh, whose holes cover whatever
  /// they lie before.
  void fit_to_pixels(std::vector<Settled>& settled) const {
    const std::size_t count = contenders(settled, pixel_margin);
    each(count, [&](std::size_t i) {
      settled[i].pose.agreement.ranking.reset();
      settled[i].pose = alignment::fit_to_pixels(mesh_, settled[i].pose, evidence_, lens_);
      settled[i].pose.spread = pixel_spread;
    });
    double most = 0;
    for (std::size_t i = 0; i < count; ++i) most = std::max(most, settled[i].pose.agreement.overlap);
    for (std::size_t i = 0; i < count && !mesh_.open; ++i) {
      Agreement& fit = settled[i].pose.agreement;
      fit.ranking = fit.score() - overlap_weight * (most - fit.overlap);
    }
    sort_by_score(settled);
  }

  /// The best of `settled` and what scores nearly as well are asked for what they say of the photo's inside.
  void by_photo(std::vector<Settled>& settled, const PhotoInside& photo, double margin) const {
    const LitMesh lit = lit_mesh(mesh_, photo.colors);
    const std::vector<InsideOfPhoto> insides = insides_of(photo, evidence_, noise_.sigma_px);
    each(contenders(settled, margin), [&](std::size_t i) {
      NoisyOutline outline = noisy_outline();
      ask_inside(outline, lit, insides, settled[i]);
    });
  }

 private:
  [[nodiscard]] NoisyOutline noisy_outline() const {
    return {mesh_, evidence_, lens_, evidence_.levels() - 1, noise_};
  }

  template <class Work>
  void each(std::size_t count, Work work) const {
    parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (progress_.stop_requested()) return;
        work(i);
      }
    });
  }

  const OutlineMesh& mesh_;
  const StencilEvidence& evidence_;
  const LensPrior& lens_;
  const OutlineNoise& noise_;
  const Progress& progress_;
};

}  // namespace

SettledPoses settled_poses(const std::vector<RefinedPose>& poses, const OutlineMesh& mesh,
                           const StencilEvidence& evidence, const LensPrior& lens,
                           const std::optional<PhotoInside>& photo, const Progress& progress) {
  SettledPoses result{poses, grid_noise};
  if (poses.empty()) return result;
  result.noise = noise_about(mesh, poses.front().pose, evidence, evidence.levels() - 1);
  result.smooth = result.noise.sigma_px < rough_px;
  const Settlement settlement(mesh, evidence, lens, result.noise, progress);
  std::vector<Settled> settled;
  if (result.smooth) {
    for (const RefinedPose& pose : poses) settled.push_back({pose});
    settlement.fit_to_pixels(settled);
    // A smooth outline tells more than the inside does, but not twins apart.
    if (photo && contenders(settled, least_margin) > 1) {
      // The inside leads: about its axis a body's facets hold the outline where it is.
      Settlement(mesh, evidence, lens, leading_noise, progress).by_photo(settled, *photo, least_margin);
      settlement.fit_to_pixels(settled);
      rank_by_inside(settled);
    }
  } else {
    settled = settlement.by_outline(poses);
    if (photo) {
      settlement.by_photo(settled, *photo, contender_margin);
      rank_by_inside(settled);
    }
  }
  sort_by_score(settled);
  result.shaded = settled.front().by_photo;
  result.inside = settled.front().inside;
  result.poses.clear();
  for (Settled& one : settled) result.poses.push_back(std::move(one.pose));
  return result;
}

}  // namespace drape::alignment
