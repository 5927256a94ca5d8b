// Mesh and photo in, camera out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drape/alignment/exhaustive_options.hpp"
#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::alignment {

enum class Method { exhaustive };

struct AlignOptions {
  Method method = Method::exhaustive;
  Camera::Projection projection = Camera::Projection::perspective;
  std::optional<double> fov_deg;
  ExhaustiveOptions exhaustive;
};

inline void describe(Binder& b, AlignOptions& o) {
  b.choice("method", o.method, {{"exhaustive", Method::exhaustive}},
           "exhaustive: every rotation on a grid, then refined (the thesis's method)");
  b.choice(
      "projection", o.projection,
      {{"perspective", Camera::Projection::perspective}, {"orthographic", Camera::Projection::orthographic}},
      "of the photo's camera; orthographic for a telephoto or telecentric lens");
  b.number(
      "fov_deg", o.fov_deg, {1, 150},
      "horizontal field of view of the photo to start from; auto: the photo's own focal length, else 45");
  describe(b, o.exhaustive);
}

/// What is known of one photo.
struct PhotoEvidence {
  /// At the photo's size, one channel: stencil::object, background or unknown.
  const Image8& stencil;
  /// Focal length as the photo's file tells it, in pixels.
  std::optional<double> focal_px_prior;
};

enum class Verdict { accept, review, reject };

struct AlignmentCandidate {
  Camera camera;
  double overlap_percent = 0;
  double score = 0;  // what the method ranks by, more is better
};

/// Times depend on the machine; all else is the same for the same input, options and seed.
struct AlignmentMetrics {
  double pass1_seconds = 0;  // from the start to the sorted list of candidates
  double total_seconds = 0;
  int candidates_listed = 0;
  int candidates_tried = 0;
  std::int64_t stencils_drawn = 0;
};

struct Alignment {
  Camera camera;               // of the photo's size, in the mesh's frame
  double overlap_percent = 0;  // of the mesh's stencil and the photo's, at the photo's size
  Verdict verdict = Verdict::review;
  std::vector<std::string> reasons;            // for the verdict, in words
  std::vector<AlignmentCandidate> candidates;  // distinct poses, best first; the first is the chosen one
  AlignmentMetrics metrics;
};

/// Finds the camera of a photo from its stencil alone, whatever way the mesh is turned. The mesh may be open,
/// in any unit and anywhere. `seed` is for methods that draw random numbers; the exhaustive one does not.
///
/// Error{input} where there is nothing to align: a mesh without extent or with broken numbers; a stencil
/// without object pixels, without background, or too small for its spread to be measured.
///
/// Method::exhaustive is chapter 4 of the thesis (Algorithms 4 to 6), with the corrections that its options
/// name. Its verdict is always `review`: a good overlap does not prove a pose.
[[nodiscard]] Alignment align_photo(const TriangleMesh& mesh, const PhotoEvidence& evidence,
                                    const AlignOptions& options, std::uint64_t seed,
                                    const Progress& progress);

}  // namespace drape::alignment
