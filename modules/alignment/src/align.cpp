#include "drape/alignment/align.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "drape/base/error.hpp"
#include "exhaustive_alignment.hpp"
#include "silhouette_alignment.hpp"

namespace drape::alignment {

namespace {

bool shows_object(const Image8& stencil) {
  return std::find(stencil.data().begin(), stencil.data().end(), stencil::object) != stencil.data().end();
}

// The stencil alone where it was given; else it first, and the colours where it proves nothing.
Alignment by_better_evidence(const TriangleMesh& mesh, const PhotoEvidence& evidence, AlignOptions options,
                             const Progress& progress) {
  const bool has_stencil = shows_object(evidence.stencil);
  const bool given = evidence.photo == nullptr || (has_stencil && evidence.stencil_confidence == 1);
  Alignment first;
  if (has_stencil || given) {
    options.evidence = EvidenceKind::stencil;
    first = align_silhouette(mesh, evidence, options, given ? progress : progress.part(0, 0.5));
    if (given || first.verdict == Verdict::accept) return first;
  }
  options.evidence = EvidenceKind::colour;
  Alignment second =
      align_silhouette(mesh, evidence, options, has_stencil ? progress.part(0.5, 1) : progress);
  // The enumeration goes from the best to the worst.
  const bool better = !has_stencil || second.verdict < first.verdict;
  return better ? second : first;
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
                      : align_silhouette(mesh, evidence, options, progress);
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
