#include "stage_pictures.hpp"

#include <fmt/core.h>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/report/contact_sheet.hpp"
#include "drape/report/overlay_picture.hpp"
#include "drape/report/scans_picture.hpp"
#include "drape/report/turntable.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace fs = std::filesystem;
namespace {

constexpr int photo_side_px = 900;

report::Picture picture(std::string title, std::string alt, std::string caption, const Image8& image) {
  // Line drawings stay sharp as PNG, but photographs and renders are many times smaller as JPEG.
  return {std::move(title), std::move(alt), std::move(caption), io::encode_image(image, "jpg", 88)};
}

report::ViewStyle views_for(const pipeline::Config& config) {
  report::ViewStyle style;
  style.up = config.input.up == 'x'   ? Eigen::Vector3d::UnitX()
             : config.input.up == 'y' ? Eigen::Vector3d::UnitY()
                                      : Eigen::Vector3d::UnitZ();
  return style;
}

// Paths of results within a finished run.
class Results {
 public:
  Results(const pipeline::Config& config, const pipeline::RunResult& result) : config_(config) {
    for (std::size_t i = 0; i < result.record.stages.size(); ++i)
      folders_.emplace_back(result.record.stages[i].stage,
                            result.folder / fmt::format("{}-{}", i + 1, result.record.stages[i].stage));
  }
  [[nodiscard]] fs::path file(const std::string& stage, const std::string& name) const {
    for (const auto& [known, folder] : folders_)
      if (known == stage) return folder / name;
    return {};
  }
  [[nodiscard]] const pipeline::Config& config() const { return config_; }

 private:
  const pipeline::Config& config_;
  std::vector<std::pair<std::string, fs::path>> folders_;
};

std::vector<report::Picture> scans_together(const Results& results) {
  const io::PosesRecord poses = io::read_poses(results.file("register", "poses.json"));
  std::vector<RangeScan> scans;
  for (std::size_t i = 0; i < poses.scans.size(); ++i)
    scans.push_back(io::read_scan_ply(results.file("ingest", "scans/" + three_digits(i) + ".ply")));
  std::vector<report::PlacedScan> placed;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (poses.scans[i].placed)
      placed.push_back(
          {scans[i].cloud.positions, scans[i].cloud.normals, {}, poses.scans[i].world_from_scan});
  report::ScansPictureStyle style;
  style.view.up = views_for(results.config()).up;
  return {picture(
      "Registered scans", "All scans in one frame, each in its own colour, from several sides",
      "Each colour is one scan. Where scans overlap, their colours should mix; a colour that lies apart is a "
      "scan that is placed wrongly.",
      report::scans_picture(placed, style))};
}

std::vector<report::Picture> mesh_from_sides(const Results& results, const std::string& stage) {
  report::TurntableStyle style;
  style.view = views_for(results.config());
  const TriangleMesh mesh = io::read_mesh(results.file(stage, "mesh.ply"));
  const bool filled = stage == "fill";
  return {picture(filled ? "Repaired mesh" : "Mesh", "The shaded mesh from several sides",
                  filled ? "Faces that hole filling made stand out in another colour." : "",
                  report::turntable(mesh, style))};
}

std::vector<report::Picture> model_from_sides(const Results& results) {
  report::TurntableStyle style;
  style.view = views_for(results.config());
  // The first view is the first photo's, so that the side that was photographed is seen first.
  const io::CamerasRecord cameras = io::read_cameras(results.file("align", "cameras.json"));
  if (!cameras.cameras.empty())
    style.view.front = cameras.cameras.front().camera.towards_camera(Eigen::Vector3d::Zero());
  const fs::path file = results.file("texture", "model.ply");
  return {picture("Textured model", "The textured model from several sides",
                  "Surface that no photo shows keeps the scan's own colours, or one neutral colour.",
                  report::turntable(io::read_textured_ply(file, file.parent_path() / "textures"), style))};
}

std::vector<report::Picture> segments_of_photos(const Results& results) {
  std::vector<report::Picture> pictures;
  const auto& photos = results.config().input.photos;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    const std::string name = photos[i].image.filename().string();
    const auto shown = [&](const fs::path& file) {
      return report::fitted(io::read_photo(file).rgb, photo_side_px, photo_side_px);
    };
    pictures.push_back(picture("Photo " + name, "The photo", "", shown(photos[i].image)));
    pictures.push_back(picture("Segments of " + name, "The photo's segments in distinct colours",
                               "Bright: the segments that were chosen as the object.",
                               shown(results.file("segment", three_digits(i) + "/segments.png"))));
    pictures.push_back(picture("Stencil of " + name, "White where the object was found, black elsewhere",
                               "White: object. Black: background. Grey: unknown.",
                               shown(results.file("segment", three_digits(i) + "/stencil.png"))));
  }
  return pictures;
}

std::vector<report::Picture> overlays(const Results& results) {
  std::vector<report::Picture> pictures;
  const auto& photos = results.config().input.photos;
  for (std::size_t i = 0; i < photos.size(); ++i)
    pictures.push_back(
        picture("Overlay on " + photos[i].image.filename().string(),
                "The photo with the outlines of the stencil and of the aligned model",
                std::string(report::overlay_caption),
                report::fitted(io::read_photo(results.file("align", three_digits(i) + "/overlay.png")).rgb,
                               photo_side_px, photo_side_px)));
  return pictures;
}

}  // namespace

std::vector<report::Picture> stage_pictures(const std::string& stage, const pipeline::Config& config,
                                            const pipeline::RunResult& result) {
  const Results results(config, result);
  if (stage == "register") return scans_together(results);
  if (stage == "mesh" || stage == "fill") return mesh_from_sides(results, stage);
  if (stage == "segment") return segments_of_photos(results);
  if (stage == "align") return overlays(results);
  if (stage == "texture") return model_from_sides(results);
  return {};
}

}  // namespace drape::stages
