#include "exhaustive_alignment.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "canonical_frame.hpp"
#include "drape/alignment/overlap.hpp"
#include "drape/base/error.hpp"
#include "drape/rendering/renderer.hpp"
#include "exhaustive_search.hpp"
#include "image_stencil.hpp"
#include "simplified_mesh.hpp"

namespace drape::alignment {
namespace {

constexpr double default_fov_deg = 45;
constexpr double degrees = 180 / std::numbers::pi;
constexpr std::size_t most_candidates = 5;
constexpr double distinct_deg = 15;
constexpr double suspect_stretch_percent = 10;  // of one focal length against the other

double start_fov_deg(const PhotoEvidence& evidence, const AlignOptions& options) {
  if (options.fov_deg) return *options.fov_deg;
  if (!evidence.focal_px_prior) return default_fov_deg;
  return 2 * std::atan(evidence.stencil.width() / 2.0 / *evidence.focal_px_prior) * degrees;
}

double angle_between_deg(const Camera& a, const Camera& b) {
  return Eigen::AngleAxisd(a.camera_from_world.linear() * b.camera_from_world.linear().transpose()).angle() *
         degrees;
}

std::vector<std::string> reasons_of(const SearchResult& found, const Alignment& alignment,
                                    const AlignOptions& options) {
  std::vector<std::string> reasons;
  reasons.push_back(fmt::format(
      "the stencils overlap by {:.1f} %, which does not prove the pose: the exhaustive method has no "
      "means to tell a right one from a wrong one of the same outline",
      alignment.overlap_percent));
  if (found.every_candidate_dropped)
    reasons.push_back(fmt::format("all {} candidates were dropped: none reached {} % at steps of {} degrees",
                                  found.candidates_tried, options.exhaustive.drop_overlap_percent,
                                  options.exhaustive.drop_step_deg));
  else if (!found.accepted)
    reasons.push_back(fmt::format("none of the {} candidates tried exceeded accept_overlap_percent ({} %)",
                                  found.candidates_tried, options.exhaustive.accept_overlap_percent));
  const double stretch_percent =
      100 * std::abs(std::log(alignment.camera.K(0, 0) / alignment.camera.K(1, 1)));
  if (stretch_percent > suspect_stretch_percent)
    reasons.push_back(
        fmt::format("the two focal lengths differ by {:.0f} %, which no lens does: the rotation is "
                    "likely to be off",
                    stretch_percent));
  return reasons;
}

// Of poses closer than `distinct_deg` to a better one only the better is shown.
std::vector<AlignmentCandidate> distinct_candidates(const SearchResult& found, const CanonicalFrame& frame,
                                                    StencilRendererPool& renderers,
                                                    const ImageStencil& image) {
  std::vector<FittedPose> poses = found.candidates;
  poses.front() = found.best;
  StencilRendererPool::Lease lease(renderers);
  std::vector<AlignmentCandidate> distinct;
  for (const FittedPose& fitted : poses) {
    if (distinct.size() == most_candidates) break;
    AlignmentCandidate candidate{frame.camera(fitted.pose), 0, fitted.fitness};
    const bool seen = std::any_of(distinct.begin(), distinct.end(), [&](const AlignmentCandidate& better) {
      return angle_between_deg(better.camera, candidate.camera) < distinct_deg;
    });
    if (seen) continue;
    const Camera small = candidate.camera.resized(image.pixels.width(), image.pixels.height());
    candidate.overlap_percent = overlap_percent(lease.renderer().draw(small), image.pixels);
    distinct.push_back(std::move(candidate));
  }
  return distinct;
}

}  // namespace

Alignment align_exhaustively(const TriangleMesh& mesh, const PhotoEvidence& evidence,
                             const AlignOptions& options, const Progress& progress) {
  const ImageStencil image = image_stencil(evidence.stencil, options.exhaustive.stencil_px);
  const CanonicalFrame frame(mesh, options.projection, evidence.stencil.width(), evidence.stencil.height());
  const TriangleMesh drawn = simplified_mesh(mesh, options.exhaustive.max_faces);
  const SearchResult found = exhaustive_search({drawn, frame, image, start_fov_deg(evidence, options)},
                                               options.exhaustive, progress);
  StencilRendererPool renderers(drawn, image.pixels.width(), image.pixels.height());

  Alignment alignment;
  alignment.camera = frame.camera(found.best.pose);
  alignment.overlap_percent =
      overlap_percent(rendering::Renderer(mesh).stencil(alignment.camera), evidence.stencil);
  alignment.candidates = distinct_candidates(found, frame, renderers, image);
  alignment.candidates.front().overlap_percent = alignment.overlap_percent;
  alignment.reasons = reasons_of(found, alignment, options);
  alignment.metrics.pass1_seconds = found.pass1_seconds;
  alignment.metrics.candidates_listed = found.candidates_listed;
  alignment.metrics.candidates_tried = found.candidates_tried;
  alignment.metrics.stencils_drawn = found.stencils_drawn;
  return alignment;
}

}  // namespace drape::alignment
