// Every option and every key of `input:` of the real stage table, changed once: which stages run again? The
// stages' names, options, reads and writes are the real ones; their bodies only write down what they were
// given, so that hundreds of runs take no time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "drape/base/files.hpp"
#include "drape/base/hash.hpp"
#include "drape/pipeline/engine.hpp"
#include "drape/pipeline/sweep.hpp"
#include "drape/stages/stage_table.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;
using pipeline::Artifact;
using pipeline::Stage;

std::string one_file(std::string pattern) {
  for (std::size_t star = 0; (star = pattern.find('*')) != std::string::npos;)
    pattern.replace(star, 1, "000");
  return pattern;
}

/// Whether what a stage writes depends on its options.
enum class Body { tells_its_options, ignores_its_options };

std::vector<Stage> table_with(Body body) {
  std::vector<Stage> table = stages::stage_table();
  for (Stage& stage : table)
    stage.instantiate = [original = stage.instantiate, reads = stage.reads, writes = stage.writes, body] {
      Stage::Instance instance = original();
      const std::vector<Option> options = instance.options;
      // The real body is held, not called: it owns what the options point to.
      instance.run = [=, held = instance.run](pipeline::StageRun& run) {
        std::string text;
        if (body == Body::tells_its_options)
          for (const Option& option : options) text += option.name + "=" + canonical(option.get()) + "\n";
        for (const Artifact& artifact : reads)
          if (const std::string file = one_file(artifact.pattern); run.has_artifact(artifact.stage, file))
            text += read_file(run.artifact(artifact.stage, file)) + "\n";
        Sha256 hash;
        hash.update(text);
        for (const std::string& pattern : writes) write_file(run.output(one_file(pattern)), hash.hex());
      };
      return instance;
    };
  return table;
}

class Quiet : public pipeline::RunObserver {
 public:
  void stage_started(const Stage&, std::size_t, std::size_t, const std::string&) override {}
  void stage_progress(const Stage&, double, std::string_view) override {}
  void stage_finished(const Stage& stage, std::size_t, std::size_t, const pipeline::StageRecord&,
                      bool ran) override {
    if (ran) made.insert(stage.name);
  }
  std::set<std::string> made;
};

/// As --set takes it: a value that the option takes and does not have. Empty if there is none.
std::string other_value(const Option& option) {
  const auto within = [&](double value) {
    return !option.range || (value >= option.range->least && value <= option.range->most);
  };
  const auto number = [&](double now) {
    std::vector<double> tries = {now + 1, now - 1, now / 2 + 0.25};
    if (option.range) {
      tries.push_back(option.range->least);
      tries.push_back(option.range->most);
    }
    for (const double value : tries)
      if (value != now && within(value) && (option.kind != OptionKind::integer || value == std::floor(value)))
        return value;
    return now;
  };
  const OptionValue now = option.get();
  switch (option.kind) {
    case OptionKind::flag:
      return std::get<bool>(now) ? "false" : "true";
    case OptionKind::choice:
      for (const std::string& choice : option.choices)
        if (choice != std::get<std::string>(now)) return choice;
      return "";
    case OptionKind::text:
      return "other";
    case OptionKind::integer: {
      const auto* value = std::get_if<std::int64_t>(&now);
      return readable(
          static_cast<std::int64_t>(number(value != nullptr ? static_cast<double>(*value) : 0.0)));
    }
    case OptionKind::number: {
      const auto* value = std::get_if<double>(&now);
      return readable(number(value != nullptr ? *value : 0.0));
    }
    case OptionKind::numbers: {
      const auto& list = std::get<std::vector<double>>(now);
      const std::size_t size = option.list_size > 0 ? option.list_size : list.size() + 1;
      return readable(std::vector<double>(size, number(list.empty() ? 0.0 : list.front())));
    }
  }
  return "";
}

class OptionChange : public ::testing::Test {
 protected:
  OptionChange() {
    for (const char* name :
         {"a.ply", "b.ply", "mesh.ply", "p.jpg", "q.jpg", "mask.png", "scans.conf", "cameras.json"})
      write_file(folder / name, name);
    write_file(
        folder / "c.yaml",
        "input: {scans: [a.ply, b.ply], photos: [{image: p.jpg}], units: m}\nworkspace: ws\noutput: model\n");
  }

  [[nodiscard]] pipeline::Config load(const std::vector<Stage>& table,
                                      const std::vector<std::string>& sets = {}) const {
    return pipeline::load_config(folder / "c.yaml", table, sets);
  }

  std::set<std::string> run(const std::vector<Stage>& table,
                            const std::vector<std::string>& sets = {}) const {
    Quiet observer;
    static_cast<void>(pipeline::run(load(table, sets), {}, observer));
    return observer.made;
  }

  /// Every "<stage>.<option>=<value>" that differs from the default, with its stage.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> changes(
      const std::vector<Stage>& table) const {
    std::vector<std::pair<std::string, std::string>> found;
    for (const pipeline::ConfiguredStage& stage : load(table).stages)
      for (const Option& option : stage.instance.options) {
        const std::string value = other_value(option);
        EXPECT_FALSE(value.empty()) << stage.stage->name << "." << option.name << " has one value only";
        found.emplace_back(stage.stage->name, stage.stage->name + "." + option.name + "=" + value);
      }
    return found;
  }

  ScratchFolder folder;
};

/// The stage and all that read what it writes, directly or not.
std::set<std::string> with_followers(const std::vector<Stage>& table, const std::set<std::string>& first) {
  std::set<std::string> all = first;
  for (const Stage& stage : table)
    if (std::any_of(stage.reads.begin(), stage.reads.end(),
                    [&](const Artifact& a) { return all.count(a.stage) != 0; }))
      all.insert(stage.name);
  return all;
}

TEST_F(OptionChange, RunsItsStageAndAllThatReadsChangedBytes) {
  const std::vector<Stage> table = table_with(Body::tells_its_options);
  EXPECT_EQ(run(table).size(), table.size());
  const auto all = changes(table);
  EXPECT_GT(all.size(), 60U);
  for (const auto& [stage, set] : all) EXPECT_EQ(run(table, {set}), with_followers(table, {stage})) << set;
  EXPECT_EQ(run(table), std::set<std::string>{});
}

TEST_F(OptionChange, RunsItsStageAloneWhereNoByteChanges) {
  const std::vector<Stage> table = table_with(Body::ignores_its_options);
  run(table);
  for (const auto& [stage, set] : changes(table))
    EXPECT_EQ(run(table, {set}), std::set<std::string>{stage}) << set;
}

TEST_F(OptionChange, IsNamedByExplain) {
  const std::vector<Stage> table = table_with(Body::tells_its_options);
  run(table);
  for (const auto& [stage, set] : changes(table)) {
    const std::string name = set.substr(0, set.find('='));
    for (const pipeline::Forecast& forecast : pipeline::explain(load(table, {set}), "")) {
      if (forecast.stage != stage) {
        EXPECT_NE(forecast.state, pipeline::Forecast::State::would_run) << set << ": " << forecast.stage;
        continue;
      }
      EXPECT_EQ(forecast.state, pipeline::Forecast::State::would_run) << set;
      ASSERT_EQ(forecast.reasons.size(), 1U) << set;
      EXPECT_EQ(forecast.reasons[0].rfind("option " + name + ": ", 0), 0U) << forecast.reasons[0];
    }
  }
}

TEST_F(OptionChange, InputKeysRunTheStagesThatReadThem) {
  const std::vector<Stage> table = table_with(Body::ignores_its_options);
  run(table);
  const std::map<std::string, std::string> parts = {
      {"input.units=mm", "units"},
      {"input.up=y", "up"},
      {"input.poses=scans.conf", "poses"},
      {"input.cameras=cameras.json", "cameras"},
      {"input.scans=[a.ply]", "scans"},
      {"input.max_points_per_scan=7", "scans"},
      {"input.photos=[{image: q.jpg}]", "photos"},
      {"input.photos=[{image: p.jpg, mask: mask.png}]", "photo_regions"},
      {"input.photos=[{image: p.jpg, scribbles: mask.png}]", "photo_regions"},
      {"input.photos=[{image: p.jpg, background: q.jpg}]", "photo_regions"},
      {"input.photos=[{image: p.jpg, box_px: [1, 2, 3, 4]}]", "photo_regions"},
      {"input.photos=[{image: p.jpg, click_px: [1, 2]}]", "photo_regions"},
      {"input.photos=[{image: p.jpg, strokes: [{is: object, points_px: [1, 2]}]}]", "photo_regions"},
      {"input.photos=[{image: p.jpg, segments: [1]}]", "photo_regions"},
      {"input.photos=[{image: p.jpg, camera: {focal_px: 9}}]", "photo_cameras"},
      {"input.photos=[{image: p.jpg, camera: {initial: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]}}]",
       "photo_cameras"},
      {"input.photos=[{image: p.jpg, camera: {points: [1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 1, 2, 3, "
       "4, 6]}}]",
       "photo_cameras"}};
  for (const auto& [set, part] : parts) {
    std::set<std::string> expected;
    for (const Stage& stage : table)
      if (std::find(stage.input_parts.begin(), stage.input_parts.end(), part) != stage.input_parts.end())
        expected.insert(stage.name);
    EXPECT_FALSE(expected.empty()) << part;
    EXPECT_EQ(run(table, {set}), expected) << set;
  }
}

TEST_F(OptionChange, ASweepOverAlignRunsWhatComesBeforeOnce) {
  const std::vector<Stage> table = table_with(Body::tells_its_options);
  write_file(
      folder / "sweep.yaml",
      read_file(folder / "c.yaml") +
          "sweep: {grid: {align.focal_px: [500, 600, 700], align.accept_overlap_percent: [90, 95, 98]}}\n");
  pipeline::Sweep sweep = pipeline::read_sweep(folder / "sweep.yaml", {});
  ASSERT_EQ(sweep.batch.objects.size(), 9U);
  pipeline::plan_batch(sweep.batch, table, false);
  pipeline::BatchRunOptions options;
  options.pool.at_once = 2;
  EXPECT_EQ(pipeline::run_objects(sweep.batch, pipeline::longest_first(sweep.batch), table, options), 0U);
  std::map<std::string, int> times;
  for (const pipeline::BatchObject& object : sweep.batch.objects) {
    const auto result = pipeline::read_object_result(sweep.batch.result_file(object.id));
    ASSERT_TRUE(result.has_value());
    for (const std::string& stage : result->ran) ++times[stage];
  }
  for (const char* stage : {"ingest", "register", "mesh", "fill", "segment"})
    EXPECT_EQ(times[stage], 1) << stage;
  for (const char* stage : {"align", "texture", "export"}) EXPECT_EQ(times[stage], 9) << stage;
}

}  // namespace
}  // namespace drape::test
