#include "drape/pipeline/records.hpp"
#include "json_file.hpp"

namespace drape::pipeline {
namespace {

Json to_json(const Metric& metric) {
  if (std::holds_alternative<double>(metric.second)) return std::get<double>(metric.second);
  return std::get<std::string>(metric.second);
}

}  // namespace

void write_stage_record(const std::filesystem::path& file, const StageRecord& record) {
  Json json;
  json["stage"] = record.stage;
  json["key"] = record.key;
  json["parts"] = Json::array();
  for (const KeyPart& part : record.parts)
    json["parts"].push_back({{"name", part.name}, {"value", part.value}, {"readable", part.readable}});
  json["files"] = Json::array();
  for (const StageFile& entry : record.files)
    json["files"].push_back({{"name", entry.name}, {"sha256", entry.digest}, {"bytes", entry.bytes}});
  json["seconds"] = record.seconds;
  json["peak_memory_mb"] = record.peak_memory_mb;
  json["made_at"] = record.made_at;
  json["versions"] = Json::object();
  for (const auto& [name, version] : record.versions) json["versions"][name] = version;
  json["metrics"] = Json::object();
  for (const Metric& metric : record.metrics) json["metrics"][metric.first] = to_json(metric);
  json["warnings"] = record.warnings;
  json["review_reasons"] = record.review_reasons;
  write_json(file, json);
}

std::optional<StageRecord> read_stage_record(const std::filesystem::path& file) {
  const std::optional<Json> json = read_json(file);
  if (!json) return std::nullopt;
  try {
    StageRecord record;
    record.stage = json->at("stage");
    record.key = json->at("key");
    for (const Json& part : json->at("parts"))
      record.parts.push_back({part.at("name"), part.at("value"), part.at("readable")});
    for (const Json& entry : json->at("files"))
      record.files.push_back({entry.at("name"), entry.at("sha256"), entry.at("bytes")});
    record.seconds = json->at("seconds");
    record.peak_memory_mb = json->at("peak_memory_mb");
    record.made_at = json->at("made_at");
    for (const auto& [name, version] : json->at("versions").items())
      record.versions.emplace_back(name, version);
    for (const auto& [name, value] : json->at("metrics").items())
      if (value.is_string())
        record.metrics.emplace_back(name, value.get<std::string>());
      else
        record.metrics.emplace_back(name, value.is_number() ? value.get<double>() : 0.0);
    record.warnings = json->at("warnings").get<std::vector<std::string>>();
    record.review_reasons = json->at("review_reasons").get<std::vector<std::string>>();
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace drape::pipeline
