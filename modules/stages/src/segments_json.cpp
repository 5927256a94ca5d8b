#include "segments_json.hpp"

#include <nlohmann/json.hpp>

#include "drape/base/error.hpp"
#include "drape/base/files.hpp"

namespace drape::stages {

void write_segments(const std::filesystem::path& file, const segmentation::Segmentation& segmentation) {
  nlohmann::ordered_json json;
  json["width"] = segmentation.stencil.width();
  json["height"] = segmentation.stencil.height();
  json["confidence"] = segmentation.confidence;
  json["how"] = segmentation.how;
  json["segments"] = nlohmann::ordered_json::array();
  for (const segmentation::SegmentInfo& segment : segmentation.segments)
    json["segments"].push_back({{"label", segment.label},
                                {"area_percent", segment.area_percent},
                                {"box_px", segment.box_px},
                                {"inside_px", segment.inside_px},
                                {"mean_color", segment.mean_color},
                                {"chosen", segment.chosen},
                                {"yaml", segment.yaml_that_picks_it}});
  write_file(file, json.dump(2) + "\n");
}

double read_confidence(const std::filesystem::path& file) {
  const nlohmann::json json = nlohmann::json::parse(read_file(file), nullptr, false);
  if (!json.is_object() || !json.contains("confidence") || !json["confidence"].is_number())
    throw input_error("{}: holds no confidence", file.string());
  return json["confidence"];
}

}  // namespace drape::stages
