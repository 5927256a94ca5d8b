#include "page_data.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "drape/base/files.hpp"
#include "drape/io/photo.hpp"
#include "drape/io/records.hpp"
#include "drape/report/readable_number.hpp"
#include "gltf_axes.hpp"
#include "rows.hpp"

namespace drape::stages {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

template <class Matrix>
Json by_rows(const Matrix& matrix) {
  Json numbers = Json::array();
  for (int row = 0; row < matrix.rows(); ++row)
    for (int column = 0; column < matrix.cols(); ++column) numbers.push_back(matrix(row, column));
  return numbers;
}

// x_workspace = metres_per_input_unit * x_input - offset.
Json from_input(const Eigen::Matrix<double, 3, 4>& P, const io::WorkspaceFrame& frame) {
  Eigen::Matrix<double, 3, 4> moved = P;
  moved.leftCols<3>() *= frame.metres_per_input_unit;
  moved.col(3) -= P.leftCols<3>() * frame.world_offset_m;
  return by_rows(moved);
}

Json segments_of(const fs::path& file) {
  Json kept = Json::array();
  const Json json = Json::parse(read_file(file), nullptr, false);
  if (!json.is_object() || !json.contains("segments")) return kept;
  for (const Json& segment : json["segments"]) {
    Json one;
    for (const char* key : {"label", "area_percent", "inside_px", "chosen"})
      if (segment.contains(key)) one[key] = segment[key];
    kept.push_back(one);
  }
  return kept;
}

Json camera_of(const io::CameraRecord& record, const io::WorkspaceFrame& frame, const std::string& number) {
  Json camera;
  camera["verdict"] = to_string(record.verdict);
  const bool posed = record.verdict != io::Verdict::reject || !record.candidates.empty();
  if (posed) camera["P_input"] = from_input(record.camera.P(), frame);
  camera["candidates"] = Json::array();
  for (std::size_t i = 0; i < std::min(record.candidates.size(), most_candidates); ++i) {
    const io::CameraCandidate& candidate = record.candidates[i];
    camera["candidates"].push_back({{"P_input", from_input(candidate.P, frame)},
                                    {"overlap_percent", candidate.overlap_percent},
                                    {"verdict", to_string(candidate.verdict)},
                                    {"picture", "candidate:" + number + ":" + std::to_string(i)}});
  }
  return camera;
}

Json photos_of(const Results& results) {
  io::CamerasRecord cameras;
  if (const fs::path file = results.file("align", "cameras.json"); !file.empty() && fs::exists(file))
    cameras = io::read_cameras(file);
  Json photos = Json::array();
  const auto& inputs = results.config().input.photos;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const std::string number = three_digits(i);
    const io::ImageSize size = io::read_photo_size(inputs[i].image);
    const fs::path segments = results.file("segment", number + "/segments.json");
    if (segments.empty() || !fs::exists(segments)) continue;
    Json photo{{"name", inputs[i].image.filename().string()},
               {"width", size.width},
               {"height", size.height},
               {"picture", "photo:" + number},
               {"regions", inputs[i].mask.empty()},
               {"segments_picture", "segments:" + number},
               {"segments", segments_of(segments)}};
    if (i < cameras.cameras.size()) photo.update(camera_of(cameras.cameras[i], cameras.frame, number));
    photos.push_back(photo);
  }
  return photos;
}

std::string unseen_text(const pipeline::RunResult& run) {
  for (const pipeline::StageRecord& stage : run.stages)
    if (stage.stage == "texture")
      for (const pipeline::Metric& metric : stage.metrics)
        if (metric.first == "unseen_percent" && std::holds_alternative<double>(metric.second))
          return "no photo shows this: " + report::readable_value(std::get<double>(metric.second)) + " %";
  return "no photo shows this";
}

}  // namespace

std::optional<report::ModelView> page_view(const Results& results, const pipeline::RunResult& run) {
  const fs::path holes = results.file("fill", "holes.json");
  if (holes.empty() || !fs::exists(holes)) return std::nullopt;
  const fs::path model = results.file("export", "model_web.glb");
  const bool modelled = !model.empty() && fs::exists(model);
  const io::WorkspaceFrame frame = io::read_holes(holes).frame;
  const std::string& name = run.record.name;
  const std::size_t slash = name.rfind('/');
  Json data{{"object", slash == std::string::npos ? name : name.substr(slash + 1)},
            {"batch", slash != std::string::npos},
            {"config", run.record.config_file},
            {"metres_per_unit", frame.metres_per_input_unit},
            {"y_up_from_input", by_rows(y_up_from(results.config().input.up))},
            {"unseen_text", unseen_text(run)},
            {"material_names", Json::object()},
            {"photos", photos_of(results)}};
  for (std::size_t i = 0; i < results.config().input.photos.size(); ++i)
    data["material_names"][three_digits(i) + "_color"] =
        results.config().input.photos[i].image.filename().string();
  if (!modelled && data["photos"].empty()) return std::nullopt;
  return report::ModelView{modelled ? read_file(model) : std::string(),
                           data.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

}  // namespace drape::stages
