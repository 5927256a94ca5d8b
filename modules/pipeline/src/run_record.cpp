#include <array>
#include <ctime>

#include "drape/pipeline/records.hpp"
#include "json_file.hpp"

namespace drape::pipeline {

void write_run_record(const std::filesystem::path& file, const RunRecord& record) {
  Json json;
  json["name"] = record.name;
  json["status"] = record.status;
  json["reasons"] = record.reasons;
  json["command"] = record.command;
  json["config_file"] = record.config_file;
  json["sets"] = record.sets;
  json["output"] = record.output;
  json["started_at"] = record.started_at;
  json["seconds"] = record.seconds;
  json["stages"] = Json::array();
  for (const RunStage& stage : record.stages)
    json["stages"].push_back(
        {{"stage", stage.stage}, {"key", stage.key}, {"ran", stage.ran}, {"seconds", stage.seconds}});
  json["config_text"] = record.config_text;
  write_json(file, json);
}

std::optional<RunRecord> read_run_record(const std::filesystem::path& file) {
  const std::optional<Json> json = read_json(file);
  if (!json) return std::nullopt;
  try {
    RunRecord record;
    record.name = json->at("name");
    record.status = json->at("status");
    record.reasons = json->at("reasons").get<std::vector<std::string>>();
    record.command = json->at("command");
    record.config_file = json->at("config_file");
    record.sets = json->at("sets").get<std::vector<std::string>>();
    record.output = json->at("output");
    record.started_at = json->at("started_at");
    record.seconds = json->at("seconds");
    for (const Json& stage : json->at("stages"))
      record.stages.push_back({stage.at("stage"), stage.at("key"), stage.at("ran"), stage.at("seconds")});
    record.config_text = json->at("config_text");
    return record;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text.data();
}

}  // namespace drape::pipeline
