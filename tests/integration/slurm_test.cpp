// Batches through a real Slurm, whose daemons the test starts itself. Skipped where Slurm is not installed.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "drape/base/files.hpp"
#include "program.hpp"
#include "slurm_cluster.hpp"
#include "support.hpp"

namespace drape::test {
namespace {

namespace fs = std::filesystem;

class Slurm : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!SlurmCluster::installed()) GTEST_SKIP() << "slurm-wlm and munge are not installed";
    cluster_ = std::make_unique<SlurmCluster>(folder / "cluster");
  }

  /// Objects of a few triangles, some of which have a broken mesh; writes objects.csv and plans it. Returns
  /// the plan's folder.
  std::string plan(int count, int every_bad, int chunk_size) {
    std::string manifest = "id,mesh,units\n";
    for (int i = 0; i < count; ++i) {
      const std::string name = "o" + std::to_string(i);
      const bool bad = every_bad > 0 && i % every_bad == 1;
      const std::string faces = bad ? "f 1 2 99\n" : "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
      write_file(folder / (name + ".obj"),
                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 " + std::to_string(1 + i) + "\n" + faces);
      manifest += name + "," + name + ".obj,mm\n";
    }
    write_file(folder / "objects.csv", manifest);
    const Outcome planned = run_drape(
        {"batch", "plan", "objects.csv", "--workspace", "ws", "--chunk-size", std::to_string(chunk_size)},
        folder.path());
    EXPECT_EQ(planned.exit_code, 0) << planned.err;
    return (folder / "ws/batches/objects").string();
  }

  /// The job's number.
  std::string submit(const std::string& plan) {
    const Outcome sent = run_drape({"batch", "submit", plan, "--executor", "slurm", "--task-minutes", "5"});
    EXPECT_EQ(sent.exit_code, 0) << sent.err;
    EXPECT_EQ(sent.out.substr(0, 9), "job      ") << sent.out;
    return sent.out.size() > 9 ? sent.out.substr(9, sent.out.find('\n') - 9) : "";
  }

  std::size_t records(const std::string& plan) {
    if (!fs::exists(fs::path(plan) / "results")) return 0;
    const fs::directory_iterator files(fs::path(plan) / "results");
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
  }

  std::string logs(const std::string& plan) { return run_shell("cat '" + plan + "'/logs/slurm-*").out; }

  ScratchFolder folder;
  std::unique_ptr<SlurmCluster> cluster_;
};

TEST_F(Slurm, AnArrayLosesNoObjectAndCountsNoneTwice) {
  const std::string planned = plan(60, 20, 8);
  submit(planned);
  submit(planned);  // Slurm may run a task twice
  ASSERT_TRUE(cluster_->wait_until_empty(120)) << logs(planned);
  EXPECT_EQ(records(planned), 60U);
  const Outcome status = run_drape({"batch", "status", planned});
  EXPECT_NE(status.out.find("ok 57  review 0  failed 3  missing 0  of 60"), std::string::npos)
      << status.out << logs(planned);
  EXPECT_EQ(status.exit_code, 1);
  // Only what is not done is sent again: the bad ones, the smallest files, are together in the last of eight
  // chunks.
  const Outcome again = run_drape({"batch", "submit", planned, "--executor", "slurm", "--dry-run"});
  EXPECT_NE(again.out.find("--chunk $((7 + SLURM_ARRAY_TASK_ID))"), std::string::npos) << again.out;
  EXPECT_NE(again.out.find("'--array=0'"), std::string::npos) << again.out;
}

TEST_F(Slurm, AnInterruptedTaskIsSentAgainAndGoesOn) {
  const std::string planned = plan(80, 0, 80);
  const std::string job = submit(planned);
  for (int i = 0; i < 3000 && records(planned) == 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const ShellOutcome signalled = run_shell("scancel --batch --signal=TERM " + job + "_0");
  ASSERT_EQ(signalled.exit_code, 0) << signalled.out;
  // Slurm lets a task that is sent again wait for two minutes, whatever the reason.
  bool waits = false;
  for (int i = 0; i < 300 && !waits; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(100)))
    waits = run_shell("squeue -h -o %r").out.find("BeginTime") != std::string::npos;
  ASSERT_TRUE(waits) << run_shell("squeue").out << logs(planned);
  EXPECT_LT(records(planned), 80U);
  ASSERT_EQ(run_shell("scontrol update jobid=" + job + "_0 starttime=now").exit_code, 0);
  ASSERT_TRUE(cluster_->wait_until_empty(120)) << logs(planned);
  const ShellOutcome job_info = run_shell("scontrol show job " + job);
  EXPECT_NE(job_info.out.find("Restarts=1"), std::string::npos) << job_info.out << logs(planned);
  const Outcome status = run_drape({"batch", "status", planned});
  EXPECT_NE(status.out.find("ok 80  review 0  failed 0  missing 0  of 80"), std::string::npos) << status.out;
  EXPECT_EQ(status.exit_code, 0);
}

}  // namespace
}  // namespace drape::test
