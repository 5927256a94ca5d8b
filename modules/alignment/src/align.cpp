#include "drape/alignment/align.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "drape/base/error.hpp"
#include "exhaustive_alignment.hpp"
#include "object_box.hpp"
#include "silhouette_alignment.hpp"

namespace drape::alignment {

namespace {

bool shows_object(const Image8& stencil) {
  return std::find(stencil.data().begin(), stencil.data().end(), stencil::object) != stencil.data().end();
}

// How much of the outline is where the photo, or its stencil, has one; 0..1.
double outline_support(const Alignment& alignment) {
  return alignment.inlier_fraction * alignment.edge_support.value_or(1);
}

// The enumeration of verdicts goes from the best to the worst; between poses for review the outline decides,
// whatever it was found by.
void keep_better(Alignment& best, Alignment next) {
  const bool tie = next.verdict == best.verdict && outline_support(next) > outline_support(best);
  if (best.candidates.empty() || next.verdict < best.verdict || tie) best = std::move(next);
}

// The stencil alone where it was given. Else it first, and the colours where it proves nothing: those round
// the stencil's object, then those of the whole photo.
Alignment by_better_evidence(const TriangleMesh& mesh, const PhotoEvidence& evidence, AlignOptions options,
                             const Progress& progress) {
  const SoughtMesh sought(mesh);
  const bool has_stencil = shows_object(evidence.stencil);
  const bool given = evidence.photo == nullptr || (has_stencil && evidence.stencil_confidence == 1);
  Alignment best;
  if (has_stencil || given) {
    options.evidence = EvidenceKind::stencil;
    best = align_silhouette(sought, evidence, options, given ? progress : progress.part(0, 0.3));
    if (given || best.verdict == Verdict::accept) return best;
  }
  options.evidence = EvidenceKind::colour;
  if (has_stencil && !evidence.box_px && !evidence.click_px) {
    PhotoEvidence boxed = evidence;
    boxed.box_px = object_box(evidence.stencil);
    keep_better(best, align_silhouette(sought, boxed, options, progress.part(0.3, 0.5)));
    if (best.verdict == Verdict::accept) return best;
  }
  keep_better(best,
              align_silhouette(sought, evidence, options, has_stencil ? progress.part(0.5, 1) : progress));
  return best;
}

}  // namespace

Alignment align_photo(const TriangleMesh& mesh, const PhotoEvidence& evidence, const AlignOptions& options,
                      std::uint64_t /*seed*/, const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string problem = problem_of(mesh);
  if (!problem.empty()) throw input_error("the mesh cannot be aligned: {}", problem);
  if (evidence.focal_px_prior && !(*evidence.focal_px_prior > 0 && std::isfinite(*evidence.focal_px_prior)))
    throw input_error("the photo's focal length is {} pixels; it must be positive", *evidence.focal_px_prior);
  Alignment alignment;
  switch (options.method) {
    case Method::silhouette:
      alignment = options.evidence == EvidenceKind::automatic
                      ? by_better_evidence(mesh, evidence, options, progress)
                      : align_silhouette(SoughtMesh(mesh), evidence, options, progress);
      break;
    case Method::exhaustive:
      alignment = align_exhaustively(mesh, evidence, options, progress);
      break;
  }
  alignment.metrics.total_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return alignment;
}

}  // namespace drape::alignment
