// Several processes in one workspace, results that change behind the engine's back, files made by hand.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "drape/base/random.hpp"
#include "drape/pipeline/adoption.hpp"
#include "drape/pipeline/file_digests.hpp"
#include "drape/pipeline/file_lock.hpp"
#include "drape/pipeline/garbage.hpp"
#include "toy_stages.hpp"

namespace drape::pipeline {
namespace {

namespace fs = std::filesystem;

template <class Work>
pid_t in_child(Work work) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  int code = 1;
  try {
    code = work();
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
  }
  ::_exit(code);
}

int exit_status(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(FileLock, IsExclusiveAndFreedByDeath) {
  const test::ScratchFolder folder;
  const fs::path file = folder / "lock";
  const pid_t holder = in_child([&] {
    const FileLock lock = FileLock::acquire(file, FileLock::Kind::exclusive);
    write_file(folder / "held", "");
    ::pause();
    return 0;
  });
  while (!fs::exists(folder / "held")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(FileLock::is_held(file));
  EXPECT_FALSE(FileLock::try_acquire(file, FileLock::Kind::shared).has_value());
  const std::atomic<bool> stop{true};
  EXPECT_THROW(static_cast<void>(FileLock::acquire(file, FileLock::Kind::exclusive, &stop)), Interrupted);
  ::kill(holder, SIGKILL);
  exit_status(holder);
  EXPECT_FALSE(FileLock::is_held(file));
  EXPECT_TRUE(FileLock::try_acquire(file, FileLock::Kind::exclusive).has_value());
}

TEST(FileLock, SharedLocksGoTogether) {
  const test::ScratchFolder folder;
  const FileLock first = FileLock::acquire(folder / "lock", FileLock::Kind::shared);
  EXPECT_TRUE(FileLock::try_acquire(folder / "lock", FileLock::Kind::shared).has_value());
  EXPECT_FALSE(FileLock::try_acquire(folder / "lock", FileLock::Kind::exclusive).has_value());
}

TEST(FileDigests, RemembersOldFilesAndDistrustsYoungOnes) {
  const test::ScratchFolder folder;
  const fs::path file = folder / "a.txt";
  write_file(file, "one");
  const auto set_digest = [&](const std::string& digest) {  // what a remembered digest would be told by
    std::string text = read_file(folder / "memory.json");
    const std::size_t at = text.find("\"sha256\": \"") + 11;
    write_file(folder / "memory.json", text.replace(at, 64, digest));
  };
  const std::string marked(64, 'f');
  FileDigests first(folder / "memory.json");
  const std::string digest = first.of(file);
  first.save();
  set_digest(marked);
  FileDigests young(folder / "memory.json");
  EXPECT_EQ(young.of(file), digest) << "it was written just now: not to be trusted";
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  FileDigests old(folder / "memory.json");
  static_cast<void>(old.of(file));
  old.save();
  set_digest(marked);
  FileDigests remembered(folder / "memory.json");
  EXPECT_EQ(remembered.of(file), marked);
  write_file(file, "two");  // the same size
  FileDigests changed(folder / "memory.json");
  EXPECT_NE(changed.of(file), marked);
  EXPECT_NE(changed.of(file), digest);
  write_file(folder / "memory.json", "{ \"files\": [{}] }");
  EXPECT_NE(FileDigests(folder / "memory.json").of(file), marked);
}

TEST(FileDigests, AnInputThatChangesUnderTheStageIsNotCached) {
  const test::ScratchFolder folder;
  write_file(folder / "a.txt", "one");
  FileDigests digests;
  static_cast<void>(digests.of(folder / "a.txt"));
  digests.check_unchanged();
  write_file(folder / "a.txt", "two");
  EXPECT_NE(test::error_message(ErrorCode::try_again, [&] { digests.check_unchanged(); }).find("a.txt"),
            std::string::npos);
}

TEST(Sharing, EightProcessesMakeEachResultOnce) {
  test::ToyProject project;
  std::vector<pid_t> children;
  for (int i = 0; i < 8; ++i)
    children.push_back(in_child([&] {
      RunOptions options;
      options.name = "run" + std::to_string(i);
      const std::string ran = project.run({}, options);
      std::ofstream(project / ("ran" + std::to_string(i))) << ran;
      return project.last.record.status == "ok" ? 0 : 1;
    }));
  std::string all;
  for (int i = 0; i < 8; ++i) {
    EXPECT_EQ(exit_status(children[static_cast<std::size_t>(i)]), 0);
    all += read_file(project / ("ran" + std::to_string(i)));
  }
  for (const std::string stage : {"read", "change", "count", "publish"}) {
    EXPECT_NE(all.find(stage), std::string::npos);
    EXPECT_EQ(all.find(stage), all.rfind(stage)) << all;
  }
  EXPECT_EQ(read_file(project / "toy-model/all.txt"), "ONE TWO THREE 14");
}

TEST(Sharing, KilledAtRandomPointsItComesToTheSameResult) {
  test::ToyProject project;
  project.run({}, {.name = "reference"});
  const std::string expected = read_file(project / "toy-model/all.txt");
  Rng rng(1);
  std::size_t killed = 0;
  for (int i = 0; i < 30; ++i) {
    fs::remove_all(project / "toy-model");
    fs::remove_all(project / "drape-workspace");
    const pid_t child = in_child([&] {
      project.run();
      return 0;
    });
    std::this_thread::sleep_for(std::chrono::microseconds(rng.below(12000)));
    ::kill(child, SIGKILL);
    killed += exit_status(child) == 128 + SIGKILL ? 1 : 0;
    project.run();
    ASSERT_EQ(read_file(project / "toy-model/all.txt"), expected) << i;
    for (const auto& entry : fs::recursive_directory_iterator(project / "drape-workspace/stages"))
      ASSERT_NE(entry.path().extension(), ".writing") << entry.path();
    ASSERT_EQ(project.run(), "");
  }
  EXPECT_GT(killed, 5U);
}

TEST(Sharing, EveryFullDiskEndsWithAnErrorAndLeavesNothingHalf) {
  // RLIMIT_FSIZE fails writes past a size as a full disk does (EFBIG instead of ENOSPC).
  test::ToyProject project;
  std::size_t failed = 0;
  for (rlim_t most = 0; most < 3000; most += 150) {
    fs::remove_all(project / "toy-model");
    fs::remove_all(project / "drape-workspace");
    const int code = exit_status(in_child([&] {
      ::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{most, most};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      try {
        project.run();
        return 0;
      } catch (const Error& error) {
        return error.code() == ErrorCode::io ? 74 : 1;
      }
    }));
    EXPECT_TRUE(code == 0 || code == 74) << most << " bytes: " << code;
    failed += code == 74 ? 1 : 0;
    project.run();  // with room again
    ASSERT_EQ(read_file(project / "toy-model/all.txt"), "ONE TWO THREE 14") << most;
  }
  EXPECT_GT(failed, 5U);
}

TEST(Sharing, EveryFlippedBitOfAResultIsNoticedByItsReader) {
  test::ToyProject project;
  project.run();
  for (const std::string file : {"1-read/words.txt", "2-change/changed/text.txt", "3-count/count.txt"}) {
    std::string bytes = read_file(project / ("drape-workspace/runs/toy/" + file));
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 4);
    std::ofstream(project / ("drape-workspace/runs/toy/" + file), std::ios::binary) << bytes;
    RunOptions again;
    again.from = file.substr(2, 4) == "read" ? "change" : "publish";
    project.run({}, again);
    EXPECT_EQ(read_file(project / "toy-model/all.txt"), "ONE TWO THREE 14") << file;
  }
}

TEST(Adoption, TakesThePlaceOfAStagesFileAndWhatDependsOnItRunsAgain) {
  test::ToyProject project;
  project.run();
  const Workspace workspace(project / "drape-workspace");
  write_file(project / "mine.txt", "by hand ");
  adopt(workspace, "toy", "read", "words.txt", project / "mine.txt", "mine.txt");
  EXPECT_EQ(project.run(), "read change count publish");
  EXPECT_EQ(read_file(project / "toy-model/all.txt"), "BY HAND 8");
  EXPECT_EQ(std::get<std::string>(project.last.stages[0].metrics.back().second), "mine.txt");
  EXPECT_EQ(project.run(), "");
  project.write_text("other words");  // a new input does not undo what a person made
  project.run();
  EXPECT_EQ(read_file(project / "toy-model/all.txt"), "BY HAND 8");
  EXPECT_EQ(forget_adoptions(workspace, "toy", "read"), 1U);
  project.run();
  EXPECT_EQ(read_file(project / "toy-model/all.txt"), "OTHER WORDS 12");
}

TEST(Adoption, ADamagedAdoptedFileIsAnErrorNotAResult) {
  test::ToyProject project;
  project.run();
  const Workspace workspace(project / "drape-workspace");
  write_file(project / "mine.txt", "by hand ");
  adopt(workspace, "toy", "read", "words.txt", project / "mine.txt", "mine.txt");
  write_file(project / "drape-workspace/runs/toy/adopted/read/words.txt", "by h?nd ");
  EXPECT_NE(test::error_message(ErrorCode::input, [&] { project.run(); }).find("adopt it again"),
            std::string::npos);
}

TEST(Garbage, IsWhatNoRunLinksTo) {
  test::ToyProject project;
  project.run({"change.capitals=false"});
  project.run();
  fs::create_directories(project / "drape-workspace/stages/read/0123.writing");
  const Workspace workspace(project / "drape-workspace");
  EXPECT_EQ(find_garbage(workspace, std::nullopt, 3600).items.size(), 1U);  // the rest is young
  EXPECT_EQ(find_garbage(workspace, std::nullopt, 0).items.size(), 3U);
  EXPECT_EQ(find_garbage(workspace, 1'000'000'000, 0).items.size(), 1U);
  const std::uint64_t linked = find_garbage(workspace, 0, 0).linked_bytes;
  {
    const FileLock busy = FileLock::acquire(workspace.users_lock(), FileLock::Kind::shared);
    EXPECT_FALSE(test::error_message(ErrorCode::try_again, [&] {
                   static_cast<void>(remove_garbage(workspace, 0, 0));
                 }).empty());
  }
  EXPECT_EQ(remove_garbage(workspace, 0, 0).linked_bytes, linked);
  EXPECT_EQ(project.run(), "");
  EXPECT_EQ(project.run({"change.capitals=false"}), "change publish");
}

}  // namespace
}  // namespace drape::pipeline
