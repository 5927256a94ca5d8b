#include "stage_pictures.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <functional>

#include "drape/base/files.hpp"
#include "drape/io/mesh_files.hpp"
#include "drape/io/model_files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/io/scan_files.hpp"
#include "drape/rendering/renderer.hpp"
#include "drape/report/contact_sheet.hpp"
#include "drape/report/overlay_picture.hpp"
#include "drape/report/readable_number.hpp"
#include "drape/report/scans_picture.hpp"
#include "drape/report/turntable.hpp"
#include "page_data.hpp"
#include "results.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace fs = std::filesystem;
namespace {

constexpr int photo_side_px = 900;
constexpr int candidate_side_px = 420;

report::Picture picture(std::string title, std::string alt, std::string caption, const Image8& image,
                        std::string key = {}) {
  return {std::move(title), std::move(alt), std::move(caption), io::encode_image(image, "jpg", 88),
          std::move(key)};
}

// Every n-th pixel: areas of one colour each keep their exact colours, and few bytes as PNG.
Image8 thinned(const Image8& image, int side_px) {
  const int step = std::max(1, (std::max(image.width(), image.height()) + side_px - 1) / side_px);
  Image8 result(image.width() / step, image.height() / step, image.channels());
  for (int y = 0; y < result.height(); ++y)
    for (int x = 0; x < result.width(); ++x)
      for (int c = 0; c < image.channels(); ++c)
        result.at(x, y, c) = image.at(x * step + step / 2, y * step + step / 2, c);
  return result;
}

report::ViewStyle views_for(const pipeline::Config& config) {
  report::ViewStyle style;
  style.up = config.input.up == 'x'   ? Eigen::Vector3d::UnitX()
             : config.input.up == 'y' ? Eigen::Vector3d::UnitY()
                                      : Eigen::Vector3d::UnitZ();
  return style;
}

// "12 mixed_pixel, 3 outlier", the most first.
std::string dropped_text(const io::ScanRecord& scan) {
  std::vector<std::pair<std::size_t, std::string>> counts;
  for (const auto& [filter, count] : scan.dropped)
    if (count > 0) counts.emplace_back(count, filter);
  std::sort(counts.begin(), counts.end(), std::greater<>());
  std::string text;
  for (const auto& [count, filter] : counts)
    text += (text.empty() ? "" : ", ") + fmt::format("{} {}", count, filter);
  return text.empty() ? "nothing was dropped" : "dropped: " + text;
}

std::vector<report::Picture> cleaned_scans(const Results& results) {
  constexpr std::size_t most_shown = 40;
  const io::ScansRecord record = io::read_scans_record(results.file("ingest", "scans.json"));
  std::vector<report::Picture> pictures;
  for (std::size_t i = 0; i < std::min(record.scans.size(), most_shown); ++i) {
    const fs::path file = results.file("ingest", "cleaning/" + three_digits(i) + ".jpg");
    if (!fs::exists(file)) continue;
    const io::ScanRecord& scan = record.scans[i];
    pictures.push_back(
        {fmt::format("Cleaning of {}{}", scan.file,
                     scan.index_in_file > 0 ? fmt::format(" ({})", scan.index_in_file) : ""),
         "The scan before and after cleaning, from the scanner and from the side",
         fmt::format("Above: before, dropped points in red; below: after. {} points are left; {}.",
                     scan.points, dropped_text(scan)),
         read_file(file)});
  }
  return pictures;
}

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
    const std::string number = three_digits(i);
    pictures.push_back(
        picture("Photo " + name, "The photo", "",
                report::fitted(io::read_photo(photos[i].image).rgb, photo_side_px, photo_side_px),
                "photo:" + number));
    pictures.push_back(
        {"Segments of " + name, "The photo's segments in distinct colours",
         "Bright: the segments that were chosen as the object.",
         io::encode_image(
             thinned(io::read_photo(results.file("segment", number + "/segments.png")).rgb, photo_side_px),
             "png"),
         "segments:" + number});
    pictures.push_back(
        {"Stencil of " + name, "White where the object was found, black elsewhere",
         "White: object. Black: background. Grey: unknown.",
         io::encode_image(report::fitted(io::read_photo(results.file("segment", number + "/stencil.png")).rgb,
                                         photo_side_px, photo_side_px),
                          "png"),
         "stencil:" + number});
  }
  return pictures;
}

// The poses that the aligner weighed, where a person may have to choose.
void add_candidates(const io::CameraRecord& record, const std::string& number, const Image8& photo,
                    const Image8& stencil, const TriangleMesh& mesh, std::vector<report::Picture>& pictures) {
  if (record.verdict == io::Verdict::accept || record.candidates.size() < 2) return;
  rendering::Renderer renderer(mesh);
  for (std::size_t k = 0; k < std::min(record.candidates.size(), most_candidates); ++k) {
    const io::CameraCandidate& candidate = record.candidates[k];
    const auto camera = camera_from_matrix(candidate.P, photo.width(), photo.height());
    if (!camera) continue;
    pictures.push_back(
        picture(fmt::format("Candidate {} of {}", k + 1, record.photo),
                fmt::format("The photo with the outline of the model in pose {}", k + 1),
                fmt::format("{} % overlap{}", report::readable_value(candidate.overlap_percent),
                            k == 0 ? "; the one that was taken" : ""),
                report::fitted(report::overlay_picture(photo, stencil, renderer.stencil(*camera)),
                               candidate_side_px, candidate_side_px),
                fmt::format("candidate:{}:{}", number, k)));
  }
}

std::vector<report::Picture> overlays(const Results& results) {
  std::vector<report::Picture> pictures;
  const auto& photos = results.config().input.photos;
  const io::CamerasRecord cameras = io::read_cameras(results.file("align", "cameras.json"));
  const bool any_to_choose =
      std::any_of(cameras.cameras.begin(), cameras.cameras.end(),
                  [](const io::CameraRecord& camera) { return camera.verdict != io::Verdict::accept; });
  TriangleMesh mesh;
  if (any_to_choose) mesh = io::read_mesh(results.file("fill", "mesh.ply"));
  for (std::size_t i = 0; i < photos.size(); ++i) {
    const std::string number = three_digits(i);
    pictures.push_back(
        picture("Overlay on " + photos[i].image.filename().string(),
                "The photo with the outlines of the stencil and of the aligned model",
                std::string(report::overlay_caption),
                report::fitted(io::read_photo(results.file("align", number + "/overlay.png")).rgb,
                               photo_side_px, photo_side_px),
                "overlay:" + number));
    if (!any_to_choose || i >= cameras.cameras.size()) continue;
    const Image8 photo = io::read_photo(photos[i].image).rgb;
    add_candidates(
        cameras.cameras[i], number, photo,
        io::read_stencil(results.file("align", number + "/stencil.png"), photo.width(), photo.height()), mesh,
        pictures);
  }
  return pictures;
}

std::vector<report::Picture> coverage(const Results& results) {
  std::vector<report::Picture> pictures = model_from_sides(results);
  const auto& photos = results.config().input.photos;
  const fs::path folder = results.file("texture", "textures");
  for (std::size_t i = 0; i < photos.size(); ++i) {
    const fs::path file = folder / (three_digits(i) + "_coverage.png");
    if (!fs::exists(file)) continue;
    pictures.push_back(
        picture("Coverage of " + photos[i].image.filename().string(),
                "The photo, dim where nothing of it is on the model",
                "Bright: pixels that are on the model as they were. Orange: replaced by colours "
                "grown from beside. Dim: not used.",
                report::fitted(io::read_photo(file).rgb, photo_side_px, photo_side_px),
                "covered:" + three_digits(i)));
  }
  for (std::size_t page = 0; fs::exists(folder / ("atlas_" + three_digits(page) + "_coverage.png")); ++page) {
    const Image8 image = io::read_photo(folder / ("atlas_" + three_digits(page) + "_coverage.png")).rgb;
    pictures.push_back({fmt::format("Atlas page {}", page + 1), "The atlas with one colour for each photo",
                        "One colour for each photo. Orange: grown. Black: nothing.",
                        io::encode_image(thinned(image, photo_side_px), "png"),
                        "coverage:atlas_" + three_digits(page) + "_color"});
  }
  return pictures;
}

}  // namespace

std::vector<report::Picture> stage_pictures(const std::string& stage, const pipeline::Config& config,
                                            const pipeline::RunResult& result) {
  const Results results(config, result);
  if (stage == "ingest") return cleaned_scans(results);
  if (stage == "register") return scans_together(results);
  if (stage == "mesh" || stage == "fill") return mesh_from_sides(results, stage);
  if (stage == "segment") return segments_of_photos(results);
  if (stage == "align") return overlays(results);
  if (stage == "texture") return coverage(results);
  return {};
}

}  // namespace drape::stages
