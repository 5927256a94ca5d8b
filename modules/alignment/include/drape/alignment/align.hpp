// Mesh and photo in, camera out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drape/alignment/block_use.hpp"
#include "drape/alignment/exhaustive_options.hpp"
#include "drape/base/options.hpp"
#include "drape/base/progress.hpp"
#include "drape/geometry/camera.hpp"
#include "drape/geometry/image.hpp"
#include "drape/geometry/triangle_mesh.hpp"

namespace drape::alignment {

enum class Method { silhouette, exhaustive };

/// What of the photo the mesh is compared with.
enum class EvidenceKind {
  automatic,  // the stencil; where that proves no pose and the photo is there, its colours as well
  stencil,
  segments,  // any union of the photo's segments
  colour,
};

struct AlignOptions {
  Method method = Method::silhouette;
  EvidenceKind evidence = EvidenceKind::automatic;
  Camera::Projection projection = Camera::Projection::perspective;
  std::optional<double> focal_px;
  std::optional<double> fov_deg;
  std::optional<double> max_roll_deg;
  std::vector<double> initial_camera;
  BlockUse block = BlockUse::automatic;
  bool share_focal = false;
  ExhaustiveOptions exhaustive;
};

inline void describe(Binder& b, AlignOptions& o) {
  b.choice("method", o.method, {{"silhouette", Method::silhouette}, {"exhaustive", Method::exhaustive}},
           "silhouette: all rotations at once, then the outline to fractions of a pixel; exhaustive: every "
           "rotation on a grid, then refined (the thesis's method)");
  b.choice(
      "evidence", o.evidence,
      {{"auto", EvidenceKind::automatic},
       {"stencil", EvidenceKind::stencil},
       {"segments", EvidenceKind::segments},
       {"colour", EvidenceKind::colour}},
      "silhouette: what of the photo the mesh is compared with. stencil: the outline that segment found; "
      "segments: any union of segment's segments; "
      "colour: the photo's colours, inside box_px, round click_px or anywhere, with no need of a stencil; "
      "auto: a given mask alone; else the stencil, where that proves no pose the colours round the stencil's "
      "object, then those of the whole photo, and the better verdict wins");
  b.choice(
      "projection", o.projection,
      {{"perspective", Camera::Projection::perspective}, {"orthographic", Camera::Projection::orthographic}},
      "of the photo's camera; orthographic for a telephoto or telecentric lens");
  b.number("focal_px", o.focal_px, {1, 1e6},
           "silhouette: focal length of the photos in pixels, held fixed; auto: found, the photo's own as a "
           "hint");
  b.number("fov_deg", o.fov_deg, {1, 150},
           "horizontal field of view of the photo; silhouette: held fixed, exhaustive: to start from; auto: "
           "found, from the photo's own focal length or none");
  b.number("max_roll_deg", o.max_roll_deg, {0, 180},
           "silhouette: input.up is up in the photos within this; auto: they may be held any way");
  b.numbers("initial_camera", o.initial_camera, 0, {-1e12, 1e12},
            "silhouette: per photo the 12 numbers of P, row by row, as cameras.json lists them for its "
            "candidates; 12 zeros: none");
  b.choice(
      "block", o.block,
      {{"auto", BlockUse::automatic}, {"given", BlockUse::given}, {"similarity", BlockUse::similarity}},
      "what the cameras of input.cameras are. given: cameras in the frame of the scans or the mesh; "
      "similarity: known among themselves alone, and brought to the mesh together by the stencils of all "
      "photos; auto: drape's own cameras.json is given, files of other programs are not");
  b.flag(
      "share_focal", o.share_focal,
      "silhouette: all photos are of one camera and zoom. Each is aligned by itself, then all again with the "
      "focal length that the accepted ones tell together");
  describe(b, o.exhaustive);
}

/// Intrinsics that are known, of one photo at its size.
struct KnownLens {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  std::vector<double> distortion;  // k1 k2 p1 p2 [k3], as OpenCV; empty: none
};

/// What is known of one photo. All but the stencil may be left out. The stencil and the photo must outlive
/// the call.
struct PhotoEvidence {
  /// At the photo's size, one channel: stencil::object, background or unknown.
  const Image8& stencil;
  /// Focal length as the photo's file tells it, in pixels: a hint that the outline may overrule.
  std::optional<double> focal_px_prior;
  /// RGB at the stencil's size: where the outline cannot tell poses apart, the best shaded comes first.
  const Image8* photo = nullptr;
  /// Kept as they are. The camera that is found then has this K, and maps undistorted pixels.
  std::optional<KnownLens> lens;
  /// About where the camera is, in the mesh's frame: only poses near it are tried.
  std::optional<Camera> initial_camera;
  /// What points upwards in the mesh's frame; with AlignOptions::max_roll_deg.
  std::optional<Eigen::Vector3d> up;
  /// How far the stencil may be trusted, 0..1; 1: it was given, and no other evidence is asked.
  double stencil_confidence = 1;
  /// For colours and segments, in photo pixels: x, y, width, height of a box round the object with some
  /// margin.
  std::optional<std::array<double, 4>> box_px;
  /// For colours and segments, in photo pixels: a point inside the object. Of no use beside a box.
  std::optional<std::array<double, 2>> click_px;
  /// For EvidenceKind::segments: labels from 0, of the stencil's size.
  const Image<std::int32_t>* segments = nullptr;
};

enum class Verdict { accept, review, reject };

struct AlignmentCandidate {
  Camera camera;
  double overlap_percent = 0;
  double score = 0;  // what the method ranks by, more is better
  Verdict verdict = Verdict::review;
};

/// Standard deviations of the pose as the outline's residuals tell them.
struct PoseSigma {
  double rotation_deg = 0;
  double direction_deg = 0;  // from the object to the camera
  double focal_percent = 0;  // 0 where it was given
};

/// A rotation of the object that its outline does not show.
struct FreeAxis {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // in the mesh's frame
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
};

/// What the verdict on an outline rests on. Shares are of the length of both outlines, 0..1.
struct OutlineFigures {
  double object_px = 0;       // longer side of the stencil's object
  double noise_px = 0;        // standard deviation of the stencil's outline about the pose's, in photo pixels
  double correlation_px = 0;  // along the outline: nearer pieces share their error
  double fits = 0;            // within 2.5 deviations, or a pixel
  double largest_gap = 0;     // what does not fit and lies together
  double margin = 1;          // of the score, over the best distinct pose
  double rotation_deg = 0;    // standard deviation about the loosest axis
  bool by_photo = false;      // the photo's inside had a say
  double inner_side = 0;      // of what the pose shows: inner sides of an open mesh, seen through its holes
  // Of the photo's inside, where a rough outline made it be asked; else 0.
  double explained = 0;    // of the variance of its brightness, by light on the mesh
  double independent = 0;  // samples of what light leaves: neighbours share their error; 300 at most
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
  /// The following only by Method::silhouette.
  EvidenceKind evidence = EvidenceKind::stencil;  // what it was found by
  /// Share of the outline that lies on an edge of the photo, 0..1; only by colours or segments.
  std::optional<double> edge_support;
  /// Only by colours or segments: the outline filled, unknown where something hides the object; of the
  /// photo's size.
  Image8 stencil;
  double inlier_fraction = 0;               // of the two outlines' length: what lies on the other one, 0..1
  std::optional<double> boundary_error_px;  // root mean square over those; nothing if there are none
  std::optional<PoseSigma> sigma;
  std::optional<OutlineFigures> outline;  // only by a stencil, where a pose was found
  std::optional<FreeAxis> free_axis;
  AlignmentMetrics metrics;
};

/// Finds the camera of a photo from its stencil, whatever way the mesh is turned. The mesh may be open, in
/// any unit and anywhere. `seed` is for methods that draw random numbers; neither of the two here does.
///
/// Error{input} where there is nothing to align: a mesh without extent or with broken numbers; a stencil
/// without object pixels, without background, or too small for its spread to be measured. Error{config} for
/// an initial camera, lens or option that makes no sense.
///
/// Method::silhouette compares polar pictures of the stencil with those of some hundred views of the mesh,
/// and refines the best by the distances between the outlines, down to the stencil's full resolution; its
/// verdict says whether the outline proves the pose. Method::exhaustive is chapter 4 of the thesis
/// (Algorithms 4 to 6), with the corrections that its options name. Its verdict is always `review`: a good
/// overlap does not prove a pose.
[[nodiscard]] Alignment align_photo(const TriangleMesh& mesh, const PhotoEvidence& evidence,
                                    const AlignOptions& options, std::uint64_t seed,
                                    const Progress& progress);

}  // namespace drape::alignment
