#include "known_cameras.hpp"

#include <algorithm>
#include <cmath>

#include "drape/alignment/align_block.hpp"
#include "drape/base/error.hpp"
#include "drape/io/block_cameras.hpp"
#include "drape/io/photo.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace {

using alignment::BlockUse;

io::CameraRecord as_given(Camera camera, const std::string& photo) {
  io::CameraRecord record;
  record.photo = photo;
  record.camera = std::move(camera);
  record.verdict = io::Verdict::accept;
  record.reasons = {"given by input.cameras"};
  record.method = "given";
  return record;
}

std::string name_of(const pipeline::PhotoInput& photo) {
  return photo.image.filename().string();
}

// Of drape's own cameras.json: both frames are metres; they differ by their offsets: x_given = x_here +
// offset_here - offset_given.
std::vector<KnownCamera> given_cameras(const io::CamerasRecord& record, const io::WorkspaceFrame& frame,
                                       const pipeline::Input& input) {
  std::vector<KnownCamera> known(input.photos.size());
  for (std::size_t i = 0; i < known.size(); ++i)
    for (const io::CameraRecord& camera : record.cameras) {
      if (camera.photo != name_of(input.photos[i])) continue;
      Camera here = camera.camera;
      here.camera_from_world.translate(Eigen::Vector3d(frame.world_offset_m - record.frame.world_offset_m));
      known[i].given = as_given(here, camera.photo);
      known[i].given->evidence = camera.evidence;
      break;
    }
  return known;
}

// The camera of a block for the photo as it is in the file.
Camera sized_camera(const io::BlockCamera& camera, const io::ImageSize& size, const std::string& photo) {
  if (camera.width > 0 && std::abs(static_cast<double>(camera.width) * size.height /
                                       (static_cast<double>(camera.height) * size.width) -
                                   1) > 0.01)
    throw input_error(
        "input.cameras has {} with {} x {} pixels; the photo has {} x {}, which is another shape", photo,
        camera.width, camera.height, size.width, size.height);
  Camera sized;
  sized.width = size.width;
  sized.height = size.height;
  sized.K = camera.K_at(size.width, size.height);
  sized.camera_from_world = camera.camera_from_block;
  return sized;
}

// The block's frame is the input's: x_input = (x_workspace + offset) / metres_per_unit, and a camera does not
// see what unit its world has.
std::vector<KnownCamera> given_block(const std::vector<io::BlockCamera>& block,
                                     const io::WorkspaceFrame& frame, const pipeline::Input& input) {
  std::vector<KnownCamera> known(input.photos.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::string name = name_of(input.photos[i]);
    const io::BlockCamera* camera = io::find_camera(block, name);
    if (camera == nullptr) continue;
    Camera here = sized_camera(*camera, io::read_photo_size(input.photos[i].image), name);
    Rigid3& pose = here.camera_from_world;
    pose.translation() =
        pose.linear() * frame.world_offset_m + frame.metres_per_input_unit * pose.translation();
    known[i].given = as_given(here, name);
  }
  return known;
}

std::vector<io::BlockCamera> block_of(const io::CamerasRecord& record) {
  std::vector<io::BlockCamera> block;
  for (const io::CameraRecord& camera : record.cameras) {
    if (camera.camera.projection != Camera::Projection::perspective) continue;
    block.push_back({camera.photo,
                     camera.camera.width,
                     camera.camera.height,
                     camera.camera.K,
                     {},
                     camera.camera.camera_from_world});
  }
  return block;
}

bool shows_object(const Image8& stencil) {
  return std::find(stencil.data().begin(), stencil.data().end(), stencil::object) != stencil.data().end();
}

std::vector<KnownCamera> aligned_block(const std::vector<io::BlockCamera>& block, const TriangleMesh& mesh,
                                       const alignment::AlignOptions& options, pipeline::StageRun& run,
                                       const Progress& progress) {
  const std::vector<pipeline::PhotoInput>& photos = run.input().photos;
  std::vector<KnownCamera> known(photos.size());
  // What a block's photo refers to stays where it is.
  std::vector<io::Photo> pictures(photos.size());
  std::vector<Image8> stencils(photos.size());
  std::vector<alignment::BlockPhoto> members;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    const io::BlockCamera* camera = io::find_camera(block, name_of(photos[i]));
    if (camera == nullptr) continue;
    pictures[i] = io::read_photo(photos[i].image);
    const io::ImageSize size{pictures[i].rgb.width(), pictures[i].rgb.height()};
    stencils[i] =
        io::read_stencil(run.artifact("segment", three_digits(i) + "/stencil.png"), size.width, size.height);
    if (!shows_object(stencils[i])) continue;
    const Camera sized = sized_camera(*camera, size, name_of(photos[i]));
    alignment::PhotoEvidence evidence{stencils[i], std::nullopt, &pictures[i].rgb};
    evidence.lens = alignment::KnownLens{sized.K, camera->distortion};
    members.push_back({evidence, sized.camera_from_world});
    indices.push_back(i);
  }
  if (members.size() < 2)
    throw config_error(
        "align.block: similarity needs two photos at least that input.cameras names and that show the "
        "object; "
        "there are {} (it names {} photos)",
        members.size(), block.size());
  const alignment::BlockAlignment found =
      alignment::align_block(mesh, members, options, run.seed(), progress);
  for (std::size_t k = 0; k < indices.size(); ++k) known[indices[k]].by_block = found.photos[k];
  return known;
}

}  // namespace

std::vector<KnownCamera> known_cameras(const TriangleMesh& mesh, const io::WorkspaceFrame& frame,
                                       const alignment::AlignOptions& options, pipeline::StageRun& run,
                                       const Progress& progress) {
  const std::filesystem::path& file = run.input().cameras;
  if (file.empty()) return std::vector<KnownCamera>(run.input().photos.size());
  if (!io::is_block_file(file)) {
    const io::CamerasRecord record = io::read_cameras(file);
    if (options.block != BlockUse::similarity) return given_cameras(record, frame, run.input());
    return aligned_block(block_of(record), mesh, options, run, progress);
  }
  const std::vector<io::BlockCamera> block = io::read_block_cameras(file);
  if (options.block == BlockUse::given) return given_block(block, frame, run.input());
  return aligned_block(block, mesh, options, run, progress);
}

}  // namespace drape::stages
