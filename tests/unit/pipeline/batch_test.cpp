#include "drape/pipeline/batch.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>

#include "drape/pipeline/batch_plan.hpp"
#include "drape/pipeline/fixes.hpp"
#include "drape/pipeline/manifest.hpp"
#include "drape/pipeline/slurm.hpp"
#include "drape/pipeline/sweep.hpp"
#include "toy_stages.hpp"

namespace drape::pipeline {
namespace {

namespace fs = std::filesystem;

// The toy stages, with an option that makes an object misbehave.
struct MischiefOptions {
  enum class Kind { none, crash, hang, spin, hog, leave };
  Kind kind = Kind::none;
};
void describe(Binder& b, MischiefOptions& o) {
  using Kind = MischiefOptions::Kind;
  b.choice("kind", o.kind,
           {{"none", Kind::none},
            {"crash", Kind::crash},
            {"hang", Kind::hang},
            {"spin", Kind::spin},
            {"hog", Kind::hog},
            {"leave", Kind::leave}},
           "what goes wrong");
}
void misbehave(const MischiefOptions& options, StageRun& run) {
  using Kind = MischiefOptions::Kind;
  if (options.kind == Kind::crash) ::raise(SIGSEGV);
  if (options.kind == Kind::leave) ::_exit(3);
  while (options.kind == Kind::hang) ::pause();
  for (volatile int i = 0; options.kind == Kind::spin;) i = i + 1;
  if (options.kind == Kind::hog) static_cast<void>(std::string(std::size_t{3} << 30, 'x'));
  write_file(run.output("done.txt"), "done");
}

std::vector<Stage> stages_with_mischief() {
  std::vector<Stage> table = test::toy_stages();
  Stage stage;
  stage.name = "mischief";
  stage.summary = "Goes wrong.";
  stage.writes = {"done.txt"};
  stage.applies = [](const Input&) { return true; };
  stage.instantiate = stage_body(misbehave);
  table.push_back(stage);
  return table;
}

class BatchTest : public ::testing::Test {
 protected:
  BatchTest() {
    for (int i = 0; i < 6; ++i)
      write_file(folder / ("t" + std::to_string(i) + ".txt"), "object " + std::to_string(i));
  }

  Batch manifest(const std::string& text, const std::string& name = "b.csv") {
    write_file(folder / name, text);
    return read_manifest(folder / name);
  }

  BatchSummary run(Batch& batch, JobLimits limits = {}, int at_once = 2) {
    plan_batch(batch, table, false);
    BatchRunOptions options;
    options.pool.at_once = at_once;
    options.limits = limits;
    EXPECT_EQ(run_objects(batch, longest_first(batch), table, options), 0U);
    return summarize(batch);
  }

  std::vector<Stage> table = stages_with_mischief();
  test::ScratchFolder folder;
};

TEST_F(BatchTest, OneObjectsTroubleDoesNotTouchTheOthers) {
  Batch batch = manifest(
      "id,mesh,mischief.kind\nfine,t0.txt,\ncrash,t1.txt,crash\nhang,t2.txt,hang\nspin,t3.txt,spin\nhog,t4."
      "txt,hog\n"
      "gone,no.txt,\nleave,t5.txt,leave\nalso,t5.txt,\n");
  const BatchSummary summary = run(batch, {.wall_seconds = 1.5, .cpu_seconds = 1, .memory_mb = 2000});
  EXPECT_EQ(summary.objects, 8U);
  EXPECT_EQ(summary.ok, 2U);
  EXPECT_EQ(summary.failed, 6U);
  EXPECT_EQ(summary.missing, 0U);
  std::map<std::string, std::string> errors;
  for (const ObjectResult& result : summary.results) errors[result.id] = result.error;
  EXPECT_EQ(errors["crash"], "crash");
  EXPECT_EQ(errors["hang"], "timeout");
  EXPECT_EQ(errors["spin"], "timeout");
  EXPECT_EQ(errors["hog"], "memory");
  EXPECT_EQ(errors["gone"], "input");
  EXPECT_EQ(errors["leave"], "io");
  EXPECT_EQ(read_file(folder / "b-models/fine/all.txt"), "OBJECT 0 9");
  EXPECT_FALSE(summary.complete());
}

TEST_F(BatchTest, ManifestsOfAllKindsMeanTheSame) {
  const Batch csv = manifest("id,mesh,units,change.capitals\na,t0.txt,mm,false\n\"b\",\"t1.txt\",mm,\n");
  const Batch yaml = manifest(
      "objects:\n  - {id: a, mesh: t0.txt, units: mm, set: {change.capitals: false}}\n"
      "  - {id: b, mesh: t1.txt, units: mm}\n",
      "b.yaml");
  ASSERT_EQ(csv.objects.size(), 2U);
  ASSERT_EQ(yaml.objects.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(flow_text(csv.objects[i].root), flow_text(yaml.objects[i].root));
  fs::create_directories(folder / "things/a");
  fs::create_directories(folder / "things/b/photos");
  fs::create_directories(folder / "things/drape-workspace");
  write_file(folder / "things/a/mesh.ply", "text");
  write_file(folder / "things/b/mesh.ply", "text");
  write_file(folder / "things/b/photos/p.jpg", "");
  write_file(folder / "things/b/photos/p_mask.png", "");
  const Batch things = read_manifest(folder / "things");
  ASSERT_EQ(things.objects.size(), 2U);
  const Config b = object_config(things, things.objects[1], table);
  EXPECT_EQ(b.input.mesh, folder / "things/b/mesh.ply");
  ASSERT_EQ(b.input.photos.size(), 1U);
  EXPECT_EQ(b.input.photos[0].mask, folder / "things/b/photos/p_mask.png");
}

TEST_F(BatchTest, AWrongManifestIsRefusedWithEveryPlace) {
  const std::string said = test::error_message(ErrorCode::config, [&] {
    static_cast<void>(manifest("id,mesh\na,t0.txt\na,t1.txt\n../up,t2.txt\n,t3.txt\n"));
  });
  EXPECT_NE(said.find("b.csv:3:1: id a is given twice"), std::string::npos) << said;
  EXPECT_NE(said.find("b.csv:4:1: id ../up"), std::string::npos) << said;
  EXPECT_NE(said.find("b.csv:5:1: an object has no id"), std::string::npos) << said;
  for (const char* text :
       {"", "id,mesh\n", "id,mehs\na,t0.txt\n", "id,mesh\na,\"t0.txt\n", "id,mesh\na,t0.txt,more\n"})
    EXPECT_FALSE(test::error_message(ErrorCode::config, [&] { static_cast<void>(manifest(text)); }).empty())
        << text;
}

TEST_F(BatchTest, AChangedObjectCountsAsMissingUntilItIsRun) {
  Batch batch = manifest("id,mesh\na,t0.txt\nb,t1.txt\n");
  EXPECT_EQ(run(batch).ok, 2U);
  Batch changed = manifest("id,mesh,change.capitals\na,t0.txt,false\nb,t1.txt,\n");
  plan_batch(changed, table, false);
  EXPECT_EQ(summarize(changed).missing_ids, std::vector<std::string>{"a"});
  const BatchSummary summary = run(changed);
  EXPECT_TRUE(summary.complete());
  EXPECT_EQ(summary.results[0].ran, (std::vector<std::string>{"change", "publish"}));
  EXPECT_EQ(summary.results[1].ran, std::vector<std::string>{});
}

TEST_F(BatchTest, APlanReadsBackAndItsWorkersNoticeChangedFiles) {
  Batch batch = manifest("id,mesh\na,t0.txt\nb,t1.txt\nc,t2.txt\n");
  plan_batch(batch, table, true);
  const BatchPlan written = write_plan(batch, 2);
  BatchPlan plan = read_plan(batch.folder());
  ASSERT_EQ(plan.classes.size(), 1U);
  EXPECT_EQ(plan.classes[0].chunks, 2);
  EXPECT_EQ(objects_of_chunk(plan, 0).size() + objects_of_chunk(plan, 1).size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(plan.batch.objects[i].digest, written.batch.objects[i].digest);
    EXPECT_EQ(plan.batch.objects[i].inputs.size(), 1U);
    EXPECT_EQ(plan.batch.result_file("a"), batch.result_file("a"));
  }
  write_file(folder / "t1.txt", "another");
  BatchRunOptions options;
  run_objects(plan.batch, longest_first(plan.batch), table, options);
  const BatchSummary summary = summarize(plan.batch);
  EXPECT_EQ(summary.ok, 2U);
  ASSERT_EQ(summary.failed, 1U);
  EXPECT_NE(summary.results[0].message.find("t1.txt: was changed since the batch was planned"),
            std::string::npos);
}

TEST_F(BatchTest, SlurmArraysCoverEachChunkOnce) {
  BatchPlan plan;
  plan.batch.name = "big";
  plan.batch.workspace = folder.path();
  plan.classes = {{1073.7, 0, 2500, 60}, {4295, 2500, 3, 7200}};
  std::set<int> chunks;
  for (int i = 0; i < 2503; ++i)
    if (i != 7) chunks.insert(i);
  const auto jobs = slurm_arrays(plan, chunks, {.program = "/opt/it's/drape"});
  ASSERT_EQ(jobs.size(), 4U);
  EXPECT_EQ(jobs[0].arguments[2], "--array=0-6,8-999");
  EXPECT_EQ(jobs[2].arguments[2], "--array=0-499");
  EXPECT_EQ(jobs[3].arguments[2], "--array=0-2");
  EXPECT_EQ(jobs[0].arguments[3], "--mem=1024M");
  EXPECT_NE(jobs[3].script.find("--chunk $((2500 + SLURM_ARRAY_TASK_ID))"), std::string::npos);
  EXPECT_NE(jobs[0].script.find("exec '/opt/it'\\''s/drape' "), std::string::npos);
  EXPECT_TRUE(slurm_arrays(plan, {}, {}).empty());
}

TEST_F(BatchTest, ASweepRunsSharedPrefixesOnce) {
  write_file(folder / "e.yaml",
             "input: {mesh: t0.txt}\nsweep:\n  seeds: [1]\n  grid:\n    change.capitals: [true, false]\n"
             "    mischief.kind: [none]\n");
  Sweep sweep = read_sweep(folder / "e.yaml", {});
  ASSERT_EQ(sweep.batch.objects.size(), 2U);
  sweep.batch.output.clear();
  EXPECT_TRUE(run(sweep.batch).complete());
  const SweepTable results = sweep_table(sweep);
  ASSERT_EQ(results.rows.size(), 2U);
  EXPECT_EQ(results.varied, 3U);
  std::size_t reads = 0;
  for (const ObjectResult& result : summarize(sweep.batch).results)
    reads += static_cast<std::size_t>(std::count(result.ran.begin(), result.ran.end(), "read"));
  EXPECT_EQ(reads, 1U);
  write_sweep_table(sweep, results);
  EXPECT_EQ(read_file(sweep.batch.folder() / "table.csv").substr(0, 62),
            "point,seed,change.capitals,mischief.kind,status,error,seconds,");
  const auto letters = std::find(results.columns.begin(), results.columns.end(), "read.letters");
  ASSERT_NE(letters, results.columns.end());
  EXPECT_EQ(results.rows[1][static_cast<std::size_t>(letters - results.columns.begin())], "9");
}

TEST_F(BatchTest, FixesGoIntoTheConfigurationByPhotoName) {
  write_file(folder / "a.jpg", "");
  write_file(folder / "b.jpg", "");
  write_file(folder / "fixes.yaml",
             "fixes:\n  - object: x\n    photos: {b.jpg: {click_px: [3, 4]}, a.jpg: {drop: true}}\n"
             "    set: {change.capitals: false}\n");
  const auto fixes = read_fixes(folder / "fixes.yaml");
  ASSERT_EQ(fixes.size(), 1U);
  ConfigNode root = parse_yaml("input: {mesh: t0.txt, photos: [a.jpg, b.jpg]}", "c");
  apply_fixes(root, fixes[0]);
  EXPECT_EQ(flow_text(root),
            "{\"input\": {\"mesh\": \"t0.txt\", \"photos\": [{\"image\": \"b.jpg\", \"click_px\": [\"3\", "
            "\"4\"]}]}, "
            "\"change\": {\"capitals\": \"false\"}}");
  ConfigNode other = parse_yaml("input: {photos: [c.jpg]}", "c");
  EXPECT_NE(
      test::error_message(ErrorCode::config, [&] { apply_fixes(other, fixes[0]); }).find("no such photo"),
      std::string::npos);
  write_fixes(folder / "kept.yaml", joined(fixes, fixes));
  EXPECT_EQ(flow_text(read_fixes(folder / "kept.yaml")[0].photos), flow_text(fixes[0].photos));
}

}  // namespace
}  // namespace drape::pipeline
