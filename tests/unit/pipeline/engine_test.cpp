#include "drape/pipeline/engine.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "drape/pipeline/workspace.hpp"
#include "toy_stages.hpp"

namespace drape::pipeline {
namespace {

namespace fs = std::filesystem;

std::size_t half_written(const fs::path& workspace) {
  std::size_t count = 0;
  for (const auto& entry : fs::recursive_directory_iterator(workspace))
    if (entry.path().extension() == ".writing") ++count;
  return count;
}

TEST(Engine, RunsOnceThenReuses) {
  test::ToyProject project;
  EXPECT_EQ(project.run(), "read change count publish");
  EXPECT_EQ(read_file(project / "toy-model/all.txt"), "ONE TWO THREE 14");
  EXPECT_EQ(project.last.record.status, "ok");
  EXPECT_EQ(project.run(), "");
  EXPECT_FALSE(project.last.anything_ran);
}

TEST(Engine, AnOptionRunsItsStageAndWhatFollowsFromChangedBytes) {
  test::ToyProject project;
  project.run();
  EXPECT_EQ(project.run({"change.capitals=false"}), "change publish");
  EXPECT_EQ(read_file(project / "toy-model/all.txt"), "one two three 14");
  EXPECT_EQ(project.run(), "");  // the former results are still there
  EXPECT_EQ(read_file(project / "toy-model/all.txt"), "ONE TWO THREE 14");
  // `read` runs again, but its words come out the same, so nothing after it does.
  EXPECT_EQ(project.run({"read.words=50"}), "read");
  EXPECT_EQ(project.run({"input.units=mm"}), "count");
  EXPECT_EQ(project.run({"seed=2"}), "read change count publish");
}

TEST(Engine, FilesCountByContentNotByPlaceOrTime) {
  test::ToyProject project;
  project.run();
  fs::last_write_time(project / "text.txt", fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(project.run(), "");
  fs::create_directories(project / "elsewhere");
  fs::copy_file(project / "text.txt", project / "elsewhere/text.txt");
  EXPECT_EQ(project.run({"input.mesh=elsewhere/text.txt"}), "");
  project.write_text("one two four");
  EXPECT_EQ(project.run(), "read change count publish");
}

TEST(Engine, LinksPointToTheResultsOfTheRun) {
  test::ToyProject project;
  project.run();
  project.run({"change.capitals=false"}, {.name = "small"});
  EXPECT_EQ(read_file(project / "drape-workspace/runs/toy/2-change/changed/text.txt"), "ONE TWO THREE ");
  EXPECT_EQ(read_file(project / "drape-workspace/runs/small/2-change/changed/text.txt"), "one two three ");
  EXPECT_TRUE(fs::is_symlink(project / "drape-workspace/runs/toy/2-change"));
  EXPECT_EQ(Workspace(project / "drape-workspace").runs().size(), 2U);
  EXPECT_TRUE(fs::exists(project / "drape-workspace/runs/toy/run.log"));
}

TEST(Engine, AFailedStageLeavesNothingAndIsNotCached) {
  test::ToyProject project;
  EXPECT_EQ(test::error_message(ErrorCode::input, [&] { project.run({"change.fail=true"}); }),
            "words.txt: asked to fail");
  EXPECT_EQ(half_written(project / "drape-workspace"), 0U);
  EXPECT_TRUE(fs::is_empty(project / "drape-workspace/stages/change"));
  const auto record = read_run_record(project / "drape-workspace/runs/toy/run.json");
  ASSERT_TRUE(record.has_value());
  EXPECT_EQ(record->status, "failed");
  EXPECT_EQ(record->reasons, std::vector<std::string>{"words.txt: asked to fail"});
  EXPECT_EQ(project.run(), "change count publish");  // `read` was kept
}

TEST(Engine, AnInterruptLeavesNothingAndTheNextRunGoesOn) {
  test::ToyProject project;
  const std::atomic<bool> stop{true};
  RunOptions options;
  options.stop = &stop;
  EXPECT_THROW(project.run({}, options), Interrupted);
  EXPECT_EQ(half_written(project / "drape-workspace"), 0U);
  EXPECT_EQ(read_run_record(project / "drape-workspace/runs/toy/run.json")->status, "interrupted");
  EXPECT_EQ(project.run(), "read change count publish");
}

TEST(Engine, UntilFromAndOnly) {
  test::ToyProject project;
  EXPECT_EQ(project.run({}, {.until = "change"}), "read change");
  EXPECT_FALSE(fs::exists(project / "toy-model"));
  EXPECT_NE(test::error_message(ErrorCode::config, [&] { project.run({}, {.only = "publish"}); })
                .find("stage count has no result"),
            std::string::npos);
  project.run();
  EXPECT_EQ(project.run({}, {.from = "count"}), "count publish");
  EXPECT_EQ(project.run({}, {.only = "change"}), "change");
  EXPECT_EQ(project.last.record.stages.size(), 4U);  // what comes after still fits
  EXPECT_EQ(project.run({"change.capitals=false"}, {.only = "change"}), "change");
  EXPECT_EQ(project.last.record.stages.size(), 3U);  // publish does not: it is left out, not shown stale
  EXPECT_FALSE(fs::exists(fs::symlink_status(project / "drape-workspace/runs/toy/4-publish")));
  EXPECT_NE(test::error_message(ErrorCode::config, [&] { project.run({}, {.from = "cuont"}); })
                .find("did you mean count?"),
            std::string::npos);
}

TEST(Engine, AMissingFileOfAResultIsMadeAgain) {
  test::ToyProject project;
  project.run();
  fs::remove(project / "drape-workspace/runs/toy/1-read/words.txt");
  EXPECT_EQ(project.run(), "read");
}

TEST(Engine, ADamagedResultIsNoticedWhenItIsReadPutAsideAndMadeAgain) {
  test::ToyProject project;
  project.run();
  write_file(project / "drape-workspace/runs/toy/1-read/words.txt",
             "one tvo three ");  // same size, other bytes
  EXPECT_EQ(project.run(), "");  // nothing reads it
  EXPECT_EQ(project.run({"change.capitals=false"}), "read change publish");
  EXPECT_EQ(read_file(project / "toy-model/all.txt"), "one two three 14");
  std::size_t aside = 0;
  for (const auto& entry : fs::directory_iterator(project / "drape-workspace/stages/read"))
    aside += entry.path().string().find(".damaged-") != std::string::npos ? 1 : 0;
  EXPECT_EQ(aside, 1U);
}

TEST(Engine, LeftoversOfDeadProcessesAreRemoved) {
  test::ToyProject project;
  project.run();
  const fs::path folder = fs::canonical(project / "drape-workspace/runs/toy/1-read");
  const fs::path leftover = folder.string() + ".writing";
  fs::create_directories(leftover / "half");
  project.run({}, {.from = "read"});
  EXPECT_FALSE(fs::exists(leftover));
}

TEST(Engine, WarningsMetricsAndReviewsAreKeptWithTheResult) {
  test::ToyProject project;
  project.write_text("who am i?");
  for (int i = 0; i < 2; ++i) {  // also when reused
    project.run();
    EXPECT_EQ(project.last.record.status, "review");
    EXPECT_EQ(project.last.record.reasons, std::vector<std::string>{"change: a question mark"});
    EXPECT_EQ(project.last.stages[1].warnings, std::vector<std::string>{"there is a question"});
    EXPECT_EQ(std::get<double>(project.last.stages[0].metrics[0].second), 10.0);
  }
}

TEST(Engine, PublishedFilesAreRestoredButOthersAreNotTouched) {
  test::ToyProject project;
  project.run();
  write_file(project / "toy-model/all.txt", "scribbled");
  write_file(project / "toy-model/mine.txt", "mine");
  EXPECT_EQ(project.run(), "");
  EXPECT_EQ(read_file(project / "toy-model/all.txt"), "ONE TWO THREE 14");
  EXPECT_EQ(read_file(project / "toy-model/mine.txt"), "mine");
}

}  // namespace
}  // namespace drape::pipeline
