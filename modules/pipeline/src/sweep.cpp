#include "drape/pipeline/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "csv.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/numbers.hpp"
#include "drape/pipeline/workspace.hpp"
#include "input_paths.hpp"
#include "input_section.hpp"
#include "json_file.hpp"

namespace drape::pipeline {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_points = 10000;

using Setting = std::pair<std::string, ConfigNode>;  // dotted name, value
using Settings = std::vector<Setting>;

void remove_key(ConfigNode& map, const std::string& key) {
  for (std::size_t i = map.keys.size(); i-- > 0;)
    if (map.keys[i].name == key) {
      map.keys.erase(map.keys.begin() + static_cast<std::ptrdiff_t>(i));
      map.items.erase(map.items.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

ConfigNode scalar(const std::string& text, const Location& where) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::scalar;
  node.text = text;
  node.where = where;
  return node;
}

std::string readable(const ConfigNode& node) {
  return node.kind == ConfigNode::Kind::scalar ? node.text : flow_text(node);
}

const ConfigNode& list_at(const ConfigNode& section, const std::string& key) {
  const ConfigNode* node = section.find(key);
  if (node == nullptr || node->kind != ConfigNode::Kind::sequence || node->items.empty())
    throw config_error("{}: sweep.{}: must be a list with at least one value",
                       node == nullptr ? section.where.text() : node->where.text(), key);
  return *node;
}

// Every way to take one of each choice; the last choice varies fastest.
std::vector<Settings> combinations(const std::vector<std::vector<Settings>>& choices, const Location& where) {
  std::vector<Settings> all = {{}};
  for (const std::vector<Settings>& choice : choices) {
    std::vector<Settings> longer;
    if (all.size() * choice.size() > most_points)
      throw config_error("{}: sweep has more than {} points", where.text(), most_points);
    for (const Settings& before : all)
      for (const Settings& next : choice) {
        longer.push_back(before);
        longer.back().insert(longer.back().end(), next.begin(), next.end());
      }
    all = std::move(longer);
  }
  return all;
}

std::vector<Settings> one_by_one(const std::string& name, const ConfigNode& list) {
  std::vector<Settings> choice;
  for (const ConfigNode& item : list.items) choice.push_back({{name, item}});
  return choice;
}

std::vector<std::vector<Settings>> choices_of(const ConfigNode& sweep) {
  std::vector<std::vector<Settings>> choices;
  if (sweep.find("objects") != nullptr) choices.push_back(one_by_one("object", list_at(sweep, "objects")));
  if (sweep.find("seeds") != nullptr) choices.push_back(one_by_one("seed", list_at(sweep, "seeds")));
  if (const ConfigNode* repeats = sweep.find("repeats")) {
    const auto count = parse_integer(repeats->text);
    if (!count || *count < 1 || *count > 1000)
      throw config_error("{}: sweep.repeats: must be a whole number from 1 to 1000", repeats->where.text());
    std::vector<Settings> seeds;
    for (std::int64_t i = 1; i <= *count; ++i)
      seeds.push_back({{"seed", scalar(fmt::format("{}", i), repeats->where)}});
    choices.push_back(seeds);
  }
  if (sweep.find("list") != nullptr) {
    std::vector<Settings> entries;
    for (const ConfigNode& entry : list_at(sweep, "list").items) {
      if (entry.kind != ConfigNode::Kind::map)
        throw config_error("{}: sweep.list: each entry must be options and values", entry.where.text());
      Settings settings;
      for (std::size_t i = 0; i < entry.keys.size(); ++i)
        settings.emplace_back(entry.keys[i].name, entry.items[i]);
      entries.push_back(settings);
    }
    choices.push_back(entries);
  }
  if (const ConfigNode* grid = sweep.find("grid"))
    for (const ConfigNode::Key& key : grid->keys)
      choices.push_back(one_by_one(key.name, list_at(*grid, key.name)));
  return choices;
}

void check_keys(const ConfigNode& sweep) {
  const std::vector<std::string> names = {"objects", "seeds", "repeats", "list", "grid"};
  for (const ConfigNode::Key& key : sweep.keys)
    if (std::find(names.begin(), names.end(), key.name) == names.end())
      throw config_error("{}", unknown_key(key, "sweep", names));
  if (sweep.find("seeds") != nullptr && sweep.find("repeats") != nullptr)
    throw config_error("{}: sweep has both seeds and repeats; leave one of them out", sweep.where.text());
}

ConfigNode object_root(const fs::path& file) {
  ConfigNode root = parse_yaml(read_file(file), file.string());
  for (const char* key : {"workspace", "output", "sweep"}) remove_key(root, key);
  make_input_paths_absolute(root, fs::absolute(file).parent_path());
  return root;
}

std::string name_of(const Setting& setting) {
  return setting.first == "object" ? fs::path(setting.second.text).stem().string() : readable(setting.second);
}

}  // namespace

Sweep read_sweep(const fs::path& config, std::span<const std::string> sets) {
  Sweep sweep;
  Batch& batch = sweep.batch;
  batch.source = fs::absolute(config).lexically_normal();
  batch.name = config.stem().string();
  batch.kind = "sweeps";
  const fs::path folder = batch.source.parent_path();
  ConfigNode root = parse_yaml(read_file(config), config.string());
  for (const std::string& set : sets) set_value(root, set);
  const ConfigNode* section = root.find("sweep");
  if (section == nullptr || section->kind != ConfigNode::Kind::map)
    throw config_error("{}: has no sweep: section of what to vary", config.string());
  check_keys(*section);
  const ConfigNode* workspace = root.find("workspace");
  batch.workspace =
      (folder / (workspace != nullptr ? workspace->text : "drape-workspace")).lexically_normal();
  const std::vector<Settings> points = combinations(choices_of(*section), section->where);
  for (const char* key : {"workspace", "output", "sweep"}) remove_key(root, key);
  make_input_paths_absolute(root, folder);

  for (const Settings& settings : points)
    for (const Setting& setting : settings)
      if (std::find(sweep.names.begin(), sweep.names.end(), setting.first) == sweep.names.end())
        sweep.names.push_back(setting.first);
  for (std::size_t i = 0; i < points.size(); ++i) {
    BatchObject object;
    object.id = fmt::format("{:03}", i + 1);
    object.root = root;
    std::vector<std::string> values(sweep.names.size());
    for (const Setting& setting : points[i]) {
      values[static_cast<std::size_t>(std::find(sweep.names.begin(), sweep.names.end(), setting.first) -
                                      sweep.names.begin())] = name_of(setting);
      if (setting.first == "name") continue;  // of a list's entry: for the table only
      if (setting.first == "object") {
        ConfigNode own = object_root(folder / setting.second.text);
        lay_over(own, object.root);
        object.root = std::move(own);
        continue;
      }
      set_value(object.root, setting.first, flow_text(setting.second));
    }
    batch.objects.push_back(std::move(object));
    sweep.values.push_back(std::move(values));
  }
  return sweep;
}

namespace {

std::string text_of(const Metric& metric) {
  return std::holds_alternative<double>(metric.second) ? format_number(std::get<double>(metric.second))
                                                       : std::get<std::string>(metric.second);
}

using Cells = std::vector<std::pair<std::string, std::string>>;

Cells cells_of(const Batch& batch, const BatchObject& object) {
  const std::optional<ObjectResult> result = read_object_result(batch.result_file(object.id));
  if (!result || result->config_digest != object.digest) return {{"status", "missing"}};
  Cells cells = {{"status", result->status},
                 {"error", result->error},
                 {"seconds", format_number(result->seconds)},
                 {"peak_memory_mb", format_number(result->peak_memory_mb)}};
  if (!result->error.empty()) return cells;
  const Workspace workspace(batch.workspace);
  const auto run = read_run_record(workspace.run_folder(batch.run_name(object.id)) / "run.json");
  if (!run) return cells;
  for (const RunStage& stage : run->stages)
    if (const auto record = workspace.find(stage.stage, stage.key)) {
      cells.emplace_back(stage.stage + ".seconds", format_number(record->seconds));
      for (const Metric& metric : record->metrics)
        cells.emplace_back(stage.stage + "." + metric.first, text_of(metric));
    }
  return cells;
}

}  // namespace

SweepTable sweep_table(const Sweep& sweep) {
  SweepTable table;
  table.columns = {"point"};
  table.columns.insert(table.columns.end(), sweep.names.begin(), sweep.names.end());
  table.varied = sweep.names.size();
  std::vector<Cells> found;
  for (const BatchObject& object : sweep.batch.objects) {
    found.push_back(cells_of(sweep.batch, object));
    for (const auto& [name, value] : found.back())
      if (std::find(table.columns.begin() + 1, table.columns.end(), name) == table.columns.end())
        table.columns.push_back(name);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::vector<std::string> row(table.columns.size());
    row[0] = sweep.batch.objects[i].id;
    std::copy(sweep.values[i].begin(), sweep.values[i].end(), row.begin() + 1);
    for (const auto& [name, value] : found[i])
      row[static_cast<std::size_t>(std::find(table.columns.begin() + 1, table.columns.end(), name) -
                                   table.columns.begin())] = value;
    table.rows.push_back(std::move(row));
  }
  return table;
}

void write_sweep_table(const Sweep& sweep, const SweepTable& table) {
  std::string csv;
  const auto add_row = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) csv += (i == 0 ? "" : ",") + csv_cell(cells[i]);
    csv += "\n";
  };
  add_row(table.columns);
  Json json = Json::array();
  for (const std::vector<std::string>& row : table.rows) {
    add_row(row);
    Json object;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (row[i].empty()) continue;
      const auto number = parse_double(row[i]);
      object[table.columns[i]] = i > 0 && number ? Json(*number) : Json(row[i]);
    }
    json.push_back(std::move(object));
  }
  make_folder(sweep.batch.folder());
  write_file(sweep.batch.folder() / "table.csv", csv);
  write_json(sweep.batch.folder() / "table.json", json);
}

}  // namespace drape::pipeline
