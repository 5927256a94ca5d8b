#include "drape/pipeline/batch_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "json_file.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

double class_of(double memory_mb) {
  const double gib = memory_mb * 1e6 / (1024.0 * 1024 * 1024);
  return std::exp2(std::max(0.0, std::ceil(std::log2(gib)))) * 1024 * 1024 * 1024 / 1e6;
}

std::string line_of(const BatchObject& object) {
  Json json;
  json["id"] = object.id;
  json["chunk"] = object.chunk;
  json["memory_mb"] = object.memory_mb;
  json["seconds"] = object.seconds;
  json["digest"] = object.digest;
  json["unreadable"] = object.unreadable;
  json["inputs"] = Json::object();
  for (const auto& [file, digest] : object.inputs) json["inputs"][file] = digest;
  json["config"] = flow_text(object.root);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

BatchObject object_of(const std::string& line, const std::string& source) {
  const Json json = Json::parse(line);
  BatchObject object;
  object.id = json.at("id");
  object.chunk = json.at("chunk");
  object.memory_mb = json.at("memory_mb");
  object.seconds = json.at("seconds");
  object.digest = json.at("digest");
  object.unreadable = json.at("unreadable");
  for (const auto& [file, digest] : json.at("inputs").items()) object.inputs.emplace_back(file, digest);
  object.root = parse_yaml(json.at("config").get<std::string>(), source);
  return object;
}

void write_files(const BatchPlan& plan) {
  std::string lines;
  for (const BatchObject& object : plan.batch.objects) lines += line_of(object);
  make_folder(plan.batch.folder());
  write_file(plan.batch.folder() / "plan.jsonl", lines);
  Json json;
  json["name"] = plan.batch.name;
  json["kind"] = plan.batch.kind;
  json["source"] = plan.batch.source.string();
  json["output"] = plan.batch.output.string();
  json["objects"] = plan.batch.objects.size();
  json["classes"] = Json::array();
  for (const MemoryClass& one : plan.classes)
    json["classes"].push_back({{"memory_mb", one.memory_mb},
                               {"first_chunk", one.first_chunk},
                               {"chunks", one.chunks},
                               {"longest_chunk_seconds", one.longest_chunk_seconds}});
  write_json(plan.batch.folder() / "plan.json", json);
}

}  // namespace

BatchPlan write_plan(Batch batch, int objects_per_chunk) {
  BatchPlan plan;
  std::map<double, std::vector<BatchObject*>> by_class;
  for (BatchObject& object : batch.objects) by_class[class_of(object.memory_mb)].push_back(&object);
  int next_chunk = 0;
  for (auto& [memory_mb, objects] : by_class) {
    std::stable_sort(objects.begin(), objects.end(),
                     [](const BatchObject* a, const BatchObject* b) { return a->seconds > b->seconds; });
    const auto per_chunk = static_cast<std::size_t>(std::max(1, objects_per_chunk));
    MemoryClass one{memory_mb, next_chunk, static_cast<int>((objects.size() + per_chunk - 1) / per_chunk), 0};
    std::vector<double> seconds(static_cast<std::size_t>(one.chunks));
    for (std::size_t i = 0; i < objects.size(); ++i) {
      objects[i]->chunk = next_chunk + static_cast<int>(i / per_chunk);
      seconds[i / per_chunk] += objects[i]->seconds;
    }
    one.longest_chunk_seconds = *std::max_element(seconds.begin(), seconds.end());
    next_chunk += one.chunks;
    plan.classes.push_back(one);
  }
  plan.batch = std::move(batch);
  write_files(plan);
  return plan;
}

bool is_plan(const fs::path& where) {
  return where.filename() == "plan.json" || fs::exists(where / "plan.json");
}

BatchPlan read_plan(const fs::path& where) {
  fs::path folder = fs::absolute(where).lexically_normal();
  if (folder.filename() == "plan.json") folder = folder.parent_path();
  if (!folder.has_filename()) folder = folder.parent_path();
  const std::optional<Json> json = read_json(folder / "plan.json");
  if (!json) throw config_error("{}: there is no plan here; make one with drape batch plan", folder.string());
  try {
    BatchPlan plan;
    plan.batch.name = json->at("name");
    plan.batch.kind = json->at("kind");
    plan.batch.source = json->at("source").get<std::string>();
    plan.batch.output = json->at("output").get<std::string>();
    // <workspace>/<kind>/<name>: where the plan lies now, as this machine sees it.
    plan.batch.workspace = folder.parent_path().parent_path();
    for (const Json& one : json->at("classes"))
      plan.classes.push_back(
          {one.at("memory_mb"), one.at("first_chunk"), one.at("chunks"), one.at("longest_chunk_seconds")});
    const std::string lines = read_file(folder / "plan.jsonl");
    for (std::size_t begin = 0; begin < lines.size();) {
      const std::size_t end = std::min(lines.find('\n', begin), lines.size());
      plan.batch.objects.push_back(object_of(lines.substr(begin, end - begin), plan.batch.source.string()));
      begin = end + 1;
    }
    if (plan.batch.objects.size() != json->at("objects").get<std::size_t>())
      throw config_error("{}: is incomplete; plan again", (folder / "plan.jsonl").string());
    return plan;
  } catch (const Json::exception& failure) {
    throw config_error("{}: is damaged; plan again ({})", folder.string(), failure.what());
  }
}

std::vector<const BatchObject*> objects_of_chunk(const BatchPlan& plan, int chunk) {
  std::vector<const BatchObject*> objects;
  for (const BatchObject* object : longest_first(plan.batch))
    if (object->chunk == chunk) objects.push_back(object);
  return objects;
}

}  // namespace drape::pipeline
