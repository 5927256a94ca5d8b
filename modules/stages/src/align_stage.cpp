#include <fmt/core.h>

#include <algorithm>

#include "drape/alignment/align.hpp"
#include "drape/alignment/point_pose.hpp"
#include "drape/alignment/shared_focal.hpp"
#include "drape/base/error.hpp"
#include "drape/base/random.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/metrics/stencil_agreement.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/report/overlay_picture.hpp"
#include "known_cameras.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

// Of the time, until the cameras of input.cameras are known, and until a focal length for all photos is.
constexpr double given_share = 0.1;
constexpr double shared_share = 0.5;

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

io::CameraRecord to_record(const alignment::Alignment& alignment, const std::string& method) {
  io::CameraRecord record;
  record.camera = alignment.camera;
  record.overlap_percent = alignment.overlap_percent;
  record.verdict = to_record(alignment.verdict);
  record.reasons = alignment.reasons;
  record.evidence = "stencil";
  record.method = method;
  record.boundary_error_px = alignment.boundary_error_px;
  if (alignment.sigma)
    record.sigma = io::CameraSigma{alignment.sigma->rotation_deg, alignment.sigma->direction_deg,
                                   alignment.sigma->focal_percent};
  for (const alignment::AlignmentCandidate& candidate : alignment.candidates)
    record.candidates.push_back(
        {candidate.camera.P(), candidate.overlap_percent, candidate.score, to_record(candidate.verdict)});
  return record;
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

bool shows_object(const Image8& stencil) {
  const std::vector<std::uint8_t>& pixels = stencil.data();
  return std::find(pixels.begin(), pixels.end(), stencil::object) != pixels.end();
}

void add_metrics(const std::string& photo, const alignment::AlignmentMetrics& metrics,
                 pipeline::StageRun& run) {
  run.metric(photo + "_pass1_s", metrics.pass1_seconds);
  run.metric(photo + "_total_s", metrics.total_seconds);
  run.metric(photo + "_candidates_listed", static_cast<double>(metrics.candidates_listed));
  run.metric(photo + "_candidates_tried", static_cast<double>(metrics.candidates_tried));
  run.metric(photo + "_stencils_drawn", static_cast<double>(metrics.stencils_drawn));
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

alignment::PhotoEvidence evidence_of(const Image8& stencil, const io::Photo& photo, std::size_t index,
                                     const alignment::AlignOptions& options, const pipeline::Input& input,
                                     const io::WorkspaceFrame& frame) {
  alignment::PhotoEvidence evidence{stencil, photo.focal_px_prior, &photo.rgb};
  const pipeline::PhotoCamera& camera = input.photos[index].camera;
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
      shown_camera(input.photos[index], evidence.focal_px_prior, frame, stencil.width(), stencil.height());
  if (!evidence.initial_camera)
    evidence.initial_camera = initial_camera(options, index, stencil.width(), stencil.height());
  evidence.up = Eigen::Vector3d(input.up == 'x', input.up == 'y', input.up == 'z');
  return evidence;
}

Image8 read_stencil(std::size_t index, const io::Photo& photo, const pipeline::StageRun& run) {
  return io::read_stencil(run.artifact("segment", three_digits(index) + "/stencil.png"), photo.rgb.width(),
                          photo.rgb.height());
}

// Of photos that nothing is known of, in lengths of a photo's longer side.
std::optional<double> focal_of_all(const TriangleMesh& mesh, const io::WorkspaceFrame& frame,
                                   const std::vector<KnownCamera>& known,
                                   const alignment::AlignOptions& options, const pipeline::StageRun& run,
                                   const Progress& progress) {
  std::vector<alignment::Alignment> alone;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i].given || known[i].by_block) continue;
    const io::Photo photo = io::read_photo(run.input().photos[i].image);
    const Image8 stencil = read_stencil(i, photo, run);
    const alignment::PhotoEvidence evidence = evidence_of(stencil, photo, i, options, run.input(), frame);
    if (evidence.lens || !shows_object(stencil)) continue;
    const auto count = static_cast<double>(known.size());
    alone.push_back(alignment::align_photo(
        mesh, evidence, options, item_seed(run.seed(), i),
        progress.part(static_cast<double>(i) / count, static_cast<double>(i + 1) / count)));
  }
  return alignment::shared_focal(alone);
}

// Aligns photo number `index`, and writes its stencil and overlay.
io::CameraRecord align_one(std::size_t index, const TriangleMesh& mesh, rendering::Renderer& renderer,
                           const io::WorkspaceFrame& frame, const KnownCamera& known,
                           std::optional<double> focal_per_side, const alignment::AlignOptions& options,
                           pipeline::StageRun& run, const Progress& progress) {
  const pipeline::PhotoInput& input = run.input().photos[index];
  const std::string name = input.image.filename().string();
  progress.update(0, name);
  const io::Photo photo = io::read_photo(input.image);
  const std::string stencil_name = three_digits(index) + "/stencil.png";
  const Image8 stencil = read_stencil(index, photo, run);
  std::optional<io::CameraRecord> record = known.given;
  if (known.by_block) record = to_record(*known.by_block, "block");
  if (!record && !shows_object(stencil)) record = rejected(stencil, method_name(options));
  if (!record) {
    alignment::AlignOptions own = options;
    if (focal_per_side) own.focal_px = *focal_per_side * std::max(stencil.width(), stencil.height());
    const alignment::Alignment alignment =
        alignment::align_photo(mesh, evidence_of(stencil, photo, index, options, run.input(), frame), own,
                               item_seed(run.seed(), index), progress);
    record = to_record(alignment, method_name(options));
    add_metrics("photo_" + three_digits(index), alignment.metrics, run);
  }
  record->photo = name;
  record->stencil = stencil_name;
  const bool posed = record->verdict != io::Verdict::reject || !record->candidates.empty();
  const Image8 model = posed ? renderer.stencil(record->camera) : Image8();
  if (record->method == "given") record->overlap_percent = metrics::stencil_overlap(stencil, model).percent();
  io::write_image(run.output(stencil_name), stencil);
  io::write_image(run.output(three_digits(index) + "/overlay.png"),
                  report::overlay_picture(photo.rgb, stencil, model));
  return *record;
}

void run(const alignment::AlignOptions& options, pipeline::StageRun& run) {
  const TriangleMesh mesh = io::read_mesh(run.artifact("fill", "mesh.ply"));
  io::CamerasRecord record;
  record.frame = io::read_holes(run.artifact("fill", "holes.json")).frame;
  const std::vector<KnownCamera> known =
      known_cameras(mesh, record.frame, options, run, run.progress().part(0, given_share));
  rendering::Renderer renderer(mesh);
  const std::size_t count = run.input().photos.size();
  double least_overlap = 100;
  double known_share = given_share;
  std::optional<double> focal;
  if (options.share_focal && options.method == alignment::Method::silhouette) {
    known_share = shared_share;
    focal =
        focal_of_all(mesh, record.frame, known, options, run, run.progress().part(given_share, shared_share));
    if (focal) run.metric("shared_focal_per_side", *focal);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const auto share = [&](std::size_t done) {
      return known_share + (1 - known_share) * static_cast<double>(done) / static_cast<double>(count);
    };
    const Progress progress = run.progress().part(share(i), share(i + 1));
    record.cameras.push_back(
        align_one(i, mesh, renderer, record.frame, known[i], focal, options, run, progress));
    const io::CameraRecord& camera = record.cameras.back();
    least_overlap = std::min(least_overlap, camera.overlap_percent);
    if (camera.verdict != io::Verdict::accept)
      run.needs_review(fmt::format("{}: {}{}", camera.photo, to_string(camera.verdict),
                                   camera.reasons.empty() ? "" : ": " + camera.reasons.front()));
  }
  io::write_cameras(run.output("cameras.json"), record);
  run.metric("overlap_percent", least_overlap);
}

}  // namespace

pipeline::Stage align_stage() {
  pipeline::Stage stage;
  stage.name = "align";
  stage.version = 4;
  stage.summary = "Finds each photo's camera by matching the mesh's outline with the photo's stencil.";
  stage.input_parts = {"photos", "photo_cameras", "cameras", "up"};
  stage.reads = {{"fill", "mesh.ply"}, {"fill", "holes.json"}, {"segment", "*/stencil.png"}};
  stage.writes = {"cameras.json", "*/stencil.png", "*/overlay.png"};
  stage.applies = [](const pipeline::Input& input) { return !input.photos.empty(); };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
