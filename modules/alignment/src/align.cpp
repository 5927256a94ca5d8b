#include "drape/alignment/align.hpp"

#include <chrono>
#include <cmath>

#include "drape/base/error.hpp"
#include "exhaustive_alignment.hpp"
#include "silhouette_alignment.hpp"

namespace drape::alignment {

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
      alignment = align_silhouette(mesh, evidence, options, progress);
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
