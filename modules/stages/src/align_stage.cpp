#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>

#include "drape/alignment/align.hpp"
#include "drape/alignment/shared_focal.hpp"
#include "drape/base/random.hpp"
#include "drape/geometry/bounding_box.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/stages/align_files.hpp"
#include "known_cameras.hpp"
#include "rows.hpp"
#include "segments_json.hpp"

namespace drape::stages {
namespace {

// Of the time, until the cameras of input.cameras are known, and until a focal length for all photos is.
constexpr double given_share = 0.1;
constexpr double shared_share = 0.5;

void add_metrics(const std::string& photo, const alignment::AlignmentMetrics& metrics,
                 pipeline::StageRun& run) {
  run.metric(photo + "_pass1_s", metrics.pass1_seconds);
  run.metric(photo + "_total_s", metrics.total_seconds);
  run.metric(photo + "_candidates_listed", static_cast<double>(metrics.candidates_listed));
  run.metric(photo + "_candidates_tried", static_cast<double>(metrics.candidates_tried));
  run.metric(photo + "_stencils_drawn", static_cast<double>(metrics.stencils_drawn));
}

// The labels of a picture in which every segment has a colour of its own.
Image<std::int32_t> painted_labels(const Image8& picture) {
  Image<std::int32_t> labels(picture.width(), picture.height(), 1, 0);
  std::map<std::array<std::uint8_t, 3>, std::int32_t> known;
  for (int y = 0; y < labels.height(); ++y)
    for (int x = 0; x < labels.width(); ++x) {
      const std::uint8_t* c = &picture.at(x, y);
      labels.at(x, y) =
          known.try_emplace({c[0], c[1], c[2]}, static_cast<std::int32_t>(known.size())).first->second;
    }
  return labels;
}

// The camera of a photo that came out of a scan file, as that file states it: for the photo with the same
// pixels, whatever its name is now. Nothing where it does not see the mesh from outside.
std::optional<Camera> stated_camera(const io::Photo& photo, const io::WorkspaceFrame& frame,
                                    const BoundingBox& box, const pipeline::StageRun& run) {
  if (!run.has_artifact("ingest", "photos/cameras.json")) return std::nullopt;
  const io::CamerasRecord record = io::read_cameras(run.artifact("ingest", "photos/cameras.json"));
  for (const io::CameraRecord& stated : record.cameras) {
    if (stated.camera.width != photo.rgb.width() || stated.camera.height != photo.rgb.height()) continue;
    const io::Photo carried = io::read_photo(run.artifact("ingest", "photos/" + stated.photo));
    if (carried.rgb.data() != photo.rgb.data()) continue;
    Camera here = stated.camera;
    here.camera_from_world.translate(Eigen::Vector3d(frame.world_offset_m - record.frame.world_offset_m));
    if ((here.camera_from_world * box.center()).z() > 0.6 * box.diagonal().norm()) return here;
  }
  return std::nullopt;
}

PhotoToAlign photo_to_align(std::size_t index, const TriangleMesh& mesh, const io::WorkspaceFrame& frame,
                            const alignment::AlignOptions& options, const pipeline::StageRun& run) {
  const std::string folder = three_digits(index);
  PhotoToAlign photo;
  photo.photo = io::read_photo(run.input().photos[index].image);
  photo.stencil = io::read_stencil(run.artifact("segment", folder + "/stencil.png"), photo.photo.rgb.width(),
                                   photo.photo.rgb.height());
  photo.stencil_confidence = read_confidence(run.artifact("segment", folder + "/segments.json"));
  if (options.evidence == alignment::EvidenceKind::segments)
    photo.segments = painted_labels(io::read_photo(run.artifact("segment", folder + "/segments.png")).rgb);
  photo.index = index;
  photo.frame = frame;
  photo.stated = stated_camera(photo.photo, frame, bounding_box(mesh.vertices), run);
  return photo;
}

// Of photos that nothing is known of, in lengths of a photo's longer side.
std::optional<double> focal_of_all(const TriangleMesh& mesh, const io::WorkspaceFrame& frame,
                                   const std::vector<KnownCamera>& known,
                                   const alignment::AlignOptions& options, const pipeline::StageRun& run,
                                   const Progress& progress) {
  std::vector<alignment::Alignment> alone;
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i].given || known[i].by_block) continue;
    const PhotoToAlign photo = photo_to_align(i, mesh, frame, options, run);
    const alignment::PhotoEvidence evidence = evidence_of(photo, options, run.input());
    if (evidence.lens || !shows_object(photo.stencil)) continue;
    const auto count = static_cast<double>(known.size());
    alone.push_back(alignment::align_photo(
        mesh, evidence, options, item_seed(run.seed(), i),
        progress.part(static_cast<double>(i) / count, static_cast<double>(i + 1) / count)));
  }
  return alignment::shared_focal(alone);
}

// Aligns photo number `index`, and writes its stencil and overlay.
io::CameraRecord align_one(std::size_t index, const TriangleMesh& mesh, const io::WorkspaceFrame& frame,
                           const KnownCamera& known, std::optional<double> focal_per_side,
                           const alignment::AlignOptions& options, pipeline::StageRun& run,
                           const Progress& progress) {
  const pipeline::PhotoInput& input = run.input().photos[index];
  const std::string name = input.image.filename().string();
  const std::string folder = three_digits(index);
  progress.update(0, name);
  PhotoToAlign photo = photo_to_align(index, mesh, frame, options, run);
  photo.given = known.given;
  if (known.by_block) photo.given = to_record(*known.by_block, "block");
  alignment::AlignOptions own = options;
  if (focal_per_side)
    own.focal_px = *focal_per_side * std::max(photo.stencil.width(), photo.stencil.height());
  const AlignedPhoto aligned =
      write_alignment_files(mesh, photo, run.input(), own, item_seed(run.seed(), index),
                            run.output(folder + "/stencil.png").parent_path(), progress);
  if (aligned.metrics) add_metrics("photo_" + folder, *aligned.metrics, run);
  io::CameraRecord record = aligned.record;
  record.stencil = folder + "/stencil.png";
  return record;
}

void run(const alignment::AlignOptions& options, pipeline::StageRun& run) {
  const TriangleMesh mesh = io::read_mesh(run.artifact("fill", "mesh.ply"));
  io::CamerasRecord record;
  record.frame = io::read_holes(run.artifact("fill", "holes.json")).frame;
  const std::vector<KnownCamera> known =
      known_cameras(mesh, record.frame, options, run, run.progress().part(0, given_share));
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
    record.cameras.push_back(align_one(i, mesh, record.frame, known[i], focal, options, run, progress));
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
  stage.version = 15;
  stage.summary =
      "Finds each photo's camera by matching the mesh's outline with the photo's stencil or colours.";
  stage.input_parts = {"photos", "photo_cameras", "photo_regions", "cameras", "up"};
  stage.reads = {{"fill", "mesh.ply"},         {"fill", "holes.json"},
                 {"ingest", "photos/*.png"},   {"ingest", "photos/cameras.json"},
                 {"segment", "*/stencil.png"}, {"segment", "*/segments.json"},
                 {"segment", "*/segments.png"}};
  stage.writes = {"cameras.json", "*/stencil.png", "*/overlay.png"};
  stage.applies = [](const pipeline::Input& input) { return !input.photos.empty(); };
  stage.instantiate = pipeline::stage_body(run);
  return stage;
}

}  // namespace drape::stages
