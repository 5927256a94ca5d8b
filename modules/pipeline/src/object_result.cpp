#include "drape/pipeline/object_result.hpp"

#include <algorithm>

#include "drape/pipeline/batch.hpp"
#include "json_file.hpp"

namespace drape::pipeline {
namespace {

int severity(const ObjectResult& result) {
  return result.status == "failed" ? 0 : result.status == "review" ? 1 : 2;
}

}  // namespace

void write_object_result(const std::filesystem::path& file, const ObjectResult& result) {
  Json json;
  json["id"] = result.id;
  json["status"] = result.status;
  json["error"] = result.error;
  json["message"] = result.message;
  json["stage"] = result.stage;
  json["config_digest"] = result.config_digest;
  json["ran"] = result.ran;
  json["seconds"] = result.seconds;
  json["stage_seconds"] = result.stage_seconds;
  json["peak_memory_mb"] = result.peak_memory_mb;
  json["host"] = result.host;
  json["finished_at"] = result.finished_at;
  json["files"] = Json::object();
  for (const auto& [name, digest] : result.files) json["files"][name] = digest;
  write_json(file, json);
}

std::optional<ObjectResult> read_object_result(const std::filesystem::path& file) {
  const std::optional<Json> json = read_json(file);
  if (!json) return std::nullopt;
  try {
    ObjectResult result;
    result.id = json->at("id");
    result.status = json->at("status");
    result.error = json->at("error");
    result.message = json->at("message");
    result.stage = json->at("stage");
    result.config_digest = json->at("config_digest");
    result.ran = json->at("ran").get<std::vector<std::string>>();
    result.seconds = json->at("seconds");
    result.stage_seconds = json->at("stage_seconds");
    result.peak_memory_mb = json->at("peak_memory_mb");
    result.host = json->at("host");
    result.finished_at = json->at("finished_at");
    for (const auto& [name, digest] : json->at("files").items()) result.files.emplace_back(name, digest);
    return result;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

BatchSummary summarize(const Batch& batch) {
  BatchSummary summary;
  summary.objects = batch.objects.size();
  for (const BatchObject& object : batch.objects) {
    std::optional<ObjectResult> result = read_object_result(batch.result_file(object.id));
    if (!result || result->config_digest != object.digest) {
      ++summary.missing;
      summary.missing_ids.push_back(object.id);
      continue;
    }
    ++(result->status == "ok" ? summary.ok : result->status == "review" ? summary.review : summary.failed);
    summary.results.push_back(std::move(*result));
  }
  std::sort(summary.results.begin(), summary.results.end(), [](const ObjectResult& a, const ObjectResult& b) {
    return severity(a) != severity(b) ? severity(a) < severity(b) : a.id < b.id;
  });
  return summary;
}

void write_summary(const Batch& batch, const BatchSummary& summary) {
  Json json;
  json["batch"] = batch.name;
  json["objects"] = summary.objects;
  json["ok"] = summary.ok;
  json["review"] = summary.review;
  json["failed"] = summary.failed;
  json["missing"] = summary.missing;
  json["results"] = Json::array();
  for (const ObjectResult& result : summary.results)
    json["results"].push_back({{"id", result.id},
                               {"status", result.status},
                               {"error", result.error},
                               {"message", result.message},
                               {"seconds", result.seconds},
                               {"peak_memory_mb", result.peak_memory_mb}});
  json["missing_ids"] = summary.missing_ids;
  write_json(batch.folder() / "summary.json", json);
}

}  // namespace drape::pipeline
