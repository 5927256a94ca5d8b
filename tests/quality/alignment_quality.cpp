// How well photos are aligned, and whether the verdict knows.
//
//   alignment_quality [--poses 20] [--clean-poses 100] [--models A,B] [--cells A,B*] [--seed 1] [--json FILE]
//                     [--ci] [--misses] [--save FOLDER] [--parts cells,negatives,lmo,dino] [--negatives 2]
//                     [--features FILE] [option=value ...]
//
// The options are those of `align:`. Models and cells (conditions) that there are: alignment/models.hpp and
// alignment/cells.cpp. --clean-poses is of the cell 20-60, --poses of every other; --ci is five of each on
// few models; --negatives: photos of each other model; --features writes what each verdict rests on (CSV);
// --misses tells every failure in a line of its own; --save writes the first photo of each row.
// `flag %`: failures that the verdict does not accept; `list %`: failures of which a right pose is among the
// candidates; `acc %`: right poses that are accepted, or of a body of rotation whose free axis is named.
#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "alignment/real_rows.hpp"
#include "alignment/summary.hpp"
#include "alignment/verdict_measure.hpp"
#include "drape/base/error.hpp"
#include "drape/base/files.hpp"
#include "drape/base/parallel.hpp"
#include "drape/io/photo.hpp"
#include "program_arguments.hpp"

namespace drape::lab {
namespace {

struct Settings {
  int poses = 20;
  int clean_poses = 100;
  std::vector<std::string> models, cells, parts;
  std::uint64_t seed = 1;
  std::string json;
  bool misses = false;
  std::string save;
  std::string features;
  int negatives = 2;  // photos of each other model
  alignment::AlignOptions options;

  [[nodiscard]] bool has(const std::string& part) const {
    return parts.empty() || std::find(parts.begin(), parts.end(), part) != parts.end();
  }
};

Settings settings_of(test::ProgramArguments& arguments) {
  Settings settings;
  const bool ci = arguments.flag("ci");
  if (ci) {
    settings.poses = settings.clean_poses = 5;
    settings.models = {"teapot", "machine_part", "fandisk.obj"};
    settings.parts = {"cells"};
  }
  settings.poses = arguments.integer("poses").value_or(settings.poses);
  settings.clean_poses = arguments.integer("clean-poses").value_or(settings.clean_poses);
  if (const auto models = arguments.list("models"); !models.empty()) settings.models = models;
  settings.cells = arguments.list("cells");
  if (const auto parts = arguments.list("parts"); !parts.empty()) settings.parts = parts;
  for (const std::string& part : settings.parts)
    if (part != "cells" && part != "negatives" && part != "lmo" && part != "dino")
      throw config_error("there is no part {}; there are cells, negatives, lmo, dino", part);
  settings.seed = static_cast<std::uint64_t>(arguments.integer("seed").value_or(1));
  settings.json = arguments.text("json").value_or("");
  settings.misses = arguments.flag("misses");
  settings.features = arguments.text("features").value_or("");
  settings.negatives = arguments.integer("negatives").value_or(settings.negatives);
  settings.save = arguments.text("save").value_or("");
  arguments.read(settings.options);
  arguments.finish();
  return settings;
}

void save_shot(const Shot& shot, const std::string& folder, const std::string& name) {
  make_folder(folder);
  io::write_image(folder + "/" + name + "-stencil.png", shot.stencil);
  if (shot.photo) io::write_image(folder + "/" + name + "-photo.png", *shot.photo);
}

Row measure(const Model& model, const Cell& cell, int poses, const Settings& settings,
            FeatureTable& features) {
  Row row{cell.name, model.name, {}};
  for (int i = 0; i < poses; ++i) {
    const Shot shot = take_shot(model, cell, settings.seed, i);
    if (i == 0 && !settings.save.empty()) save_shot(shot, settings.save, cell.name + "-" + model.name);
    Trial trial = align_shot(model, cell, shot, settings.options);
    trial.index = i;
    features.add(cell.name, model.name, i, trial.right ? "right" : "wrong", trial.about_ray_deg,
                 trial.verdict, trial.outline, trial.sigma_deg);
    row.trials.push_back(std::move(trial));
  }
  return row;
}

std::vector<Row> measure_cells(const std::vector<Model>& models, const Settings& settings,
                               FeatureTable& features) {
  std::vector<Row> rows;
  print_header();
  for (const Cell& cell : cells_named(settings.cells)) {
    Row pooled{cell.name, "all", {}};
    Row thin{cell.name, "thin or holed", {}};
    Row solid{cell.name, "the others", {}};
    for (const Model& model : models) {
      if (cell.painted && !model.painted()) continue;
      const bool clean = cell.name == all_cells().front().name;
      rows.push_back(measure(model, cell, clean ? settings.clean_poses : settings.poses, settings, features));
      print_row(rows.back());
      if (settings.misses) print_failures(rows.back());
      for (Row* group : {&pooled, model.thin_or_holed ? &thin : &solid})
        group->trials.insert(group->trials.end(), rows.back().trials.begin(), rows.back().trials.end());
    }
    // Less overlap is asked of the thin and the holed.
    for (Row* group : {&solid, &thin, &pooled}) {
      if (group->trials.empty()) continue;
      group->pooled = true;
      print_row(*group);
      rows.push_back(std::move(*group));
    }
  }
  return rows;
}

void run(test::ProgramArguments& arguments) {
  const Settings settings = settings_of(arguments);
  set_thread_count(1);
  FeatureTable features(settings.features);
  nlohmann::json json;
  std::vector<Judged> verdicts;
  const bool simulated = settings.has("cells") || settings.has("negatives");
  const std::vector<Model> models = simulated ? load_models(settings.models) : std::vector<Model>();
  if (settings.has("cells")) {
    std::vector<Row> rows = measure_cells(models, settings, features);
    for (const Row& row : rows) json["rows"].push_back(to_json(row));
    std::erase_if(rows, [](const Row& row) { return row.pooled; });
    verdicts = judged(rows);
  }
  if (settings.has("negatives")) {
    const auto negatives =
        measure_negatives(models, settings.negatives, settings.seed, settings.options, features);
    verdicts.insert(verdicts.end(), negatives.begin(), negatives.end());
  }
  if (simulated) {
    print_verdicts(verdicts);
    json["verdicts"] = verdicts_json(verdicts);
  }
  if (settings.has("lmo")) json["lmo"] = measure_lmo(settings.options);
  if (settings.has("dino")) json["dino"] = measure_dino(settings.options);
  if (!settings.json.empty()) write_file(settings.json, json.dump(2) + "\n");
}

}  // namespace
}  // namespace drape::lab

int main(int count, char** texts) {
  return drape::test::measuring_main(count, texts, drape::lab::run);
}
