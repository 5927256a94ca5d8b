#include "trials.hpp"

#include <algorithm>
#include <cmath>

#include "drape/base/random.hpp"
#include "drape/metrics/stencil_agreement.hpp"
#include "drape/rendering/renderer.hpp"
#include "lit_photo.hpp"
#include "program_arguments.hpp"
#include "stencil_faults.hpp"

namespace drape::lab {
namespace {

constexpr double hint_error = 0.03;
constexpr double axis_cosine = 0.996;  // 5 degrees

Image8 with_fault(const Image8& stencil, const Cell& cell, std::uint64_t seed) {
  switch (cell.fault) {
    case Fault::none:
      return stencil;
    case Fault::boundary_noise:
      return with_boundary_noise(stencil, cell.amount, seed);
    case Fault::missing:
      return with_missing_part(stencil, cell.amount, seed);
    case Fault::extra:
      return with_extra_part(stencil, cell.amount, seed);
    case Fault::pin_holes:
      return with_pin_holes(stencil, cell.amount, seed);
  }
  return stencil;
}

double error_about_ray(const Camera& found, const Camera& truth, const Model& model) {
  return error_modulo_symmetry(found, truth, model).rotation_about_ray_deg;
}

}  // namespace

Shot take_shot(const Model& model, const Cell& cell, std::uint64_t seed, int index) {
  const std::uint64_t item = item_seed(seed, static_cast<std::uint64_t>(index));
  Shot shot;
  shot.truth = random_view(ball_about(model.object), cell.lens, item, cell.off_center);
  const Image8 outline = rendering::Renderer(model.object).stencil(shot.truth);
  shot.stencil = with_fault(outline, cell, item_seed(item, 1));
  if (cell.photo) shot.photo = lit_photo(model.object, shot.truth, cell.painted, item_seed(item, 2));
  if (cell.focal_hint)
    shot.focal_px_hint =
        metrics::focal_px(shot.truth) * std::exp(hint_error * Rng(item_seed(item, 3)).normal());
  return shot;
}

Trial align_shot(const Model& model, const Cell& cell, const Shot& shot,
                 const alignment::AlignOptions& options) {
  alignment::AlignOptions asked = options;
  asked.projection = cell.lens.projection;
  alignment::PhotoEvidence evidence{shot.stencil, shot.focal_px_hint};
  if (shot.photo) evidence.photo = &*shot.photo;
  Trial trial;
  const double before = test::cpu_seconds();
  const alignment::Alignment found = alignment::align_photo(model.scanned, evidence, asked, 1, {});
  trial.cpu_seconds = test::cpu_seconds() - before;
  trial.verdict = found.verdict;
  trial.reasons = found.reasons;
  trial.confidence = margin(found);
  trial.outline = found.outline;
  if (found.sigma) trial.sigma_deg = found.sigma->rotation_deg;
  if (found.candidates.empty()) {
    trial.rotation_deg = trial.about_ray_deg = 180;
    return trial;
  }
  const metrics::CameraError error = error_modulo_symmetry(found.camera, shot.truth, model);
  trial.rotation_deg = error.rotation_deg;
  trial.about_ray_deg = error.rotation_about_ray_deg;
  trial.focal_percent = error.focal_percent;
  trial.right = error.rotation_about_ray_deg < right_deg;
  rendering::Renderer renderer(model.object);
  trial.overlap_percent =
      metrics::stencil_overlap(renderer.stencil(found.camera), renderer.stencil(shot.truth)).percent();
  trial.has_axis = model.symmetry.about_z;
  trial.axis_named = trial.has_axis && found.free_axis &&
                     std::abs(found.free_axis->direction.normalized().z()) > axis_cosine;
  for (const alignment::AlignmentCandidate& candidate : found.candidates) {
    const double deg = error_about_ray(candidate.camera, shot.truth, model);
    trial.best_candidate_deg = std::min(deg, trial.best_candidate_deg.value_or(deg));
  }
  return trial;
}

std::string verdict_name(alignment::Verdict verdict) {
  switch (verdict) {
    case alignment::Verdict::accept:
      return "accept";
    case alignment::Verdict::review:
      return "review";
    case alignment::Verdict::reject:
      return "reject";
  }
  return "?";
}

double margin(const alignment::Alignment& found) {
  if (found.candidates.size() < 2) return found.candidates.empty() ? 0 : 1;
  return found.candidates[0].score - found.candidates[1].score;
}

}  // namespace drape::lab
