#include "drape/stages/align_files.hpp"

#include <algorithm>

#include "drape/alignment/point_pose.hpp"
#include "drape/base/error.hpp"
#include "drape/metrics/stencil_agreement.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/report/overlay_picture.hpp"

namespace drape::stages {
namespace {

io::Verdict to_record(alignment::Verdict verdict) {
  switch (verdict) {
    case alignment::Verdict::accept:
      return io::Verdict::accept;
    case alignment::Verdict::review:
      return io::Verdict::review;
    case alignment::Verdict::reject:
      return io::Verdict::reject;
  }
  return io::Verdict::reject;
}

std::string evidence_name(alignment::EvidenceKind kind) {
  if (kind == alignment::EvidenceKind::segments) return "segments";
  return kind == alignment::EvidenceKind::colour ? "colour" : "stencil";
}

// For a photo in which segmentation found nothing: the others of the run are aligned all the same.
io::CameraRecord rejected(const Image8& stencil, const std::string& method) {
  io::CameraRecord record;
  record.camera.width = stencil.width();
  record.camera.height = stencil.height();
  record.verdict = io::Verdict::reject;
  record.reasons = {"the object was not found in the photo; give a mask, box_px or click_px in input.photos"};
  record.evidence = "stencil";
  record.method = method;
  return record;
}

std::string method_name(const alignment::AlignOptions& options) {
  return options.method == alignment::Method::exhaustive ? "exhaustive" : "silhouette";
}

// P of align.initial_camera, taken apart: the left part of P is an upper triangular K times a rotation.
std::optional<Camera> initial_camera(const alignment::AlignOptions& options, std::size_t index, int width,
                                     int height) {
  if (options.initial_camera.size() % 12 != 0)
    throw config_error("align.initial_camera has {} numbers; it must have 12 for each photo",
                       options.initial_camera.size());
  if (options.initial_camera.size() < 12 * (index + 1)) return std::nullopt;
  const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> P =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(options.initial_camera.data() +
                                                                     12 * index);
  if (P.isZero(0)) return std::nullopt;
  const std::optional<Camera> camera = camera_from_matrix(P, width, height);
  if (!camera) throw config_error("align.initial_camera: the numbers of photo {} are no camera", index);
  return camera;
}

// The camera that the photo's own `initial` or `points` tell about, in the workspace's frame.
std::optional<Camera> shown_camera(const pipeline::PhotoInput& photo, std::optional<double> focal_px,
                                   const io::WorkspaceFrame& frame, int width, int height) {
  const std::string name = photo.image.filename().string();
  if (photo.camera.initial) {
    Eigen::Matrix<double, 3, 4> P =
        Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(photo.camera.initial->data());
    // x_input = (x_workspace + offset) / metres_per_input_unit.
    P.leftCols<3>() /= frame.metres_per_input_unit;
    P.col(3) += P.leftCols<3>() * frame.world_offset_m;
    const std::optional<Camera> camera = camera_from_matrix(P, width, height);
    if (!camera) throw config_error("{}: the numbers of camera.initial are no camera", name);
    return camera;
  }
  if (photo.camera.points.empty()) return std::nullopt;
  std::vector<alignment::PointPair> pairs;
  for (const auto& p : photo.camera.points)
    pairs.push_back({{p[0], p[1]}, frame.from_input({p[2], p[3], p[4]})});
  try {
    return alignment::camera_from_points(pairs, width, height, focal_px).camera;
  } catch (const Error& error) {
    throw config_error("{}: camera.points: {}", name, error.what());
  }
}

// What a scan file states of a photo's place may be wrong, or told in another frame than the registered
// scans have: then the photo is searched like any other.
alignment::Alignment aligned_by_search(const TriangleMesh& mesh, const PhotoToAlign& photo,
                                       const pipeline::Input& input, const alignment::AlignOptions& options,
                                       std::uint64_t seed, const Progress& progress) {
  const auto align = [&](const PhotoToAlign& one, const Progress& part) {
    return alignment::align_photo(mesh, evidence_of(one, options, input), options, seed, part);
  };
  if (!photo.stated) return align(photo, progress);
  alignment::Alignment near = align(photo, progress.part(0, 0.5));
  if (near.verdict == alignment::Verdict::accept) {
    near.reasons.push_back("found near the place that the scan file states");
    return near;
  }
  PhotoToAlign unstated = photo;
  unstated.stated.reset();
  alignment::Alignment anywhere = align(unstated, progress.part(0.5, 1));
  return anywhere.verdict == alignment::Verdict::accept ? anywhere : near;
}

}  // namespace

io::CameraRecord to_record(const alignment::Alignment& alignment, const std::string& method) {
  io::CameraRecord record;
  record.camera = alignment.camera;
  record.overlap_percent = alignment.overlap_percent;
  record.verdict = to_record(alignment.verdict);
  record.reasons = alignment.reasons;
  record.evidence = evidence_name(alignment.evidence);
  record.method = method;
  record.edge_support = alignment.edge_support;
  record.boundary_error_px = alignment.boundary_error_px;
  if (alignment.sigma)
    record.sigma = io::CameraSigma{alignment.sigma->rotation_deg, alignment.sigma->direction_deg,
                                   alignment.sigma->focal_percent};
  for (const alignment::AlignmentCandidate& candidate : alignment.candidates)
    record.candidates.push_back(
        {candidate.camera.P(), candidate.overlap_percent, candidate.score, to_record(candidate.verdict)});
  return record;
}

bool shows_object(const Image8& stencil) {
  const std::vector<std::uint8_t>& pixels = stencil.data();
  return std::find(pixels.begin(), pixels.end(), stencil::object) != pixels.end();
}

alignment::PhotoEvidence evidence_of(const PhotoToAlign& given, const alignment::AlignOptions& options,
                                     const pipeline::Input& input) {
  const Image8& stencil = given.stencil;
  alignment::PhotoEvidence evidence{stencil, given.photo.focal_px_prior, &given.photo.rgb};
  const std::size_t index = given.index;
  const pipeline::PhotoInput& told = input.photos[index];
  evidence.stencil_confidence = given.stencil_confidence;
  evidence.box_px = told.box_px;
  evidence.click_px = told.click_px;
  if (!given.segments.empty()) evidence.segments = &given.segments;
  const pipeline::PhotoCamera& camera = told.camera;
  if (camera.K || camera.focal_px) {
    alignment::KnownLens lens;
    if (camera.K)
      lens.K = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(camera.K->data());
    else
      lens.K << *camera.focal_px, 0, stencil.width() / 2.0, 0, *camera.focal_px, stencil.height() / 2.0, 0, 0,
          1;
    lens.distortion = camera.distortion;
    evidence.lens = lens;
    evidence.focal_px_prior = lens.K(0, 0);
  }
  evidence.initial_camera =
      shown_camera(told, evidence.focal_px_prior, given.frame, stencil.width(), stencil.height());
  if (!evidence.initial_camera)
    evidence.initial_camera = initial_camera(options, index, stencil.width(), stencil.height());
  if (given.stated) {
    if (!evidence.lens) {
      evidence.lens = alignment::KnownLens{given.stated->K, {}};
      evidence.focal_px_prior = given.stated->K(0, 0);
    }
    if (!evidence.initial_camera) evidence.initial_camera = given.stated;
  }
  evidence.up = Eigen::Vector3d(input.up == 'x', input.up == 'y', input.up == 'z');
  return evidence;
}

AlignedPhoto write_alignment_files(const TriangleMesh& mesh, const PhotoToAlign& given,
                                   const pipeline::Input& input, const alignment::AlignOptions& options,
                                   std::uint64_t seed, const std::filesystem::path& folder,
                                   const Progress& progress) {
  AlignedPhoto aligned;
  Image8 stencil = given.stencil;
  const bool by_stencil =
      options.method == alignment::Method::exhaustive || options.evidence == alignment::EvidenceKind::stencil;
  if (given.given) {
    aligned.record = *given.given;
  } else if (by_stencil && !shows_object(stencil)) {
    aligned.record = rejected(stencil, method_name(options));
  } else {
    const alignment::Alignment alignment = aligned_by_search(mesh, given, input, options, seed, progress);
    aligned.record = to_record(alignment, method_name(options));
    aligned.metrics = alignment.metrics;
    if (!alignment.stencil.empty()) stencil = alignment.stencil;
  }
  io::CameraRecord& record = aligned.record;
  record.photo = input.photos[given.index].image.filename().string();
  const bool posed = record.verdict != io::Verdict::reject || !record.candidates.empty();
  const Image8 model = posed ? rendering::Renderer(mesh).stencil(record.camera) : Image8();
  if (record.method == "given") record.overlap_percent = metrics::stencil_overlap(stencil, model).percent();
  io::write_image(folder / "stencil.png", stencil);
  io::write_image(folder / "overlay.png", report::overlay_picture(given.photo.rgb, stencil, model));
  return aligned;
}

}  // namespace drape::stages
