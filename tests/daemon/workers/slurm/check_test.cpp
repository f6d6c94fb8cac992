// `hydroprintd admin check` with a real Slurm.
#include <gtest/gtest.h>
#include <signal.h>

#include "daemon/workers/slurm/node_jobs.h"
#include "tests/daemon/api/support.h"
#include "tests/daemon/workers/slurm/cluster.h"

namespace hydroprint::tests {
namespace {

using daemon::CheckLine;

class ClusterCheck : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = Cluster::missing(); !missing.empty()) GTEST_SKIP() << missing;
    cluster.emplace();
    std::filesystem::create_directories(shared());
    std::filesystem::create_directories(folder.path() / "state");
    write_config("");
  }

  [[nodiscard]] std::filesystem::path shared() const { return folder.path() / "shared"; }
  void write_config(const std::string& more) const {
    std::ofstream(config()) << "[workers]\nprogram = \"" << worker.string()
                            << "\"\nexecutor = \"slurm\"\n[workers.slurm]\nfolder = \""
                            << shared().string() << "\"\n"
                            << more;
  }
  [[nodiscard]] std::filesystem::path config() const { return folder.path() / "check.toml"; }
  [[nodiscard]] std::vector<std::string> command() const {
    return {testing::program_path("hydroprintd"),
            "admin",
            "check",
            "--config",
            config(),
            "--state-dir",
            folder.path() / "state"};
  }
  [[nodiscard]] testing::Ended check() const { return testing::run(command()); }
  /// Names and states of the jobs that wait or run.
  static std::string open_jobs() {
    return Cluster::ask({"/usr/bin/squeue", "--noheader", "--format=%j %T"});
  }
  /// Occupies both nodes with one job.
  [[nodiscard]] static bool keep_nodes_busy() {
    (void)Cluster::ask({"/usr/bin/sbatch", "--job-name=busy", "--nodes=2", "--exclusive",
                        "--output=/dev/null", "--wrap=sleep 600"});
    return wait_until([] { return open_jobs() == "busy RUNNING\n"; });
  }

  TemporaryFolder folder;
  std::filesystem::path worker = testing::program_path("daemon_fake_worker");
  std::optional<Cluster> cluster;
};

TEST_F(ClusterCheck, EachNodeIsOkBesideADaemonAndNothingIsLeft) {
  DaemonProcess::Options options = DaemonProcess::fake();
  options.workers =
      "executor = \"slurm\"\n[workers.slurm]\nfolder = \"" + shared().string() + "\"\n";
  const DaemonProcess beside(folder.path(), options);
  const testing::Ended ended = check();
  EXPECT_EQ(ended.status, 0) << ended.out << ended.err;
  for (const char* line : {"ok    worker: ", "ok    confinement: ", "ok    state folder: ",
                           "ok    shared folder: ", "ok    installation folder: ",
                           "ok    Slurm programs: ", "ok    Slurm controller: answers; 2 nodes\n",
                           "ok    submission: ", "ok    node node1: ", "ok    node node2: "}) {
    EXPECT_NE(ended.out.find(line), std::string::npos) << line << "\n" << ended.out;
  }
  for (const auto& entry : std::filesystem::directory_iterator(shared())) {
    EXPECT_EQ(entry.path().filename(), "default") << "the daemon's";
  }
  EXPECT_EQ(open_jobs(), "");
}

TEST_F(ClusterCheck, NodeWithAnotherBuildIsAFaultWithBothIds) {
  worker = folder.path() / "worker";
  std::ofstream(worker) << "#!/bin/sh\nif [ -n \"$SLURM_JOB_ID\" ]; then id=bb; else id=aa; fi\n"
                           "[ \"$1\" = --version ] && echo \"{\\\"build_id\\\": \\\"$id\\\"}\"\n";
  std::filesystem::permissions(worker, std::filesystem::perms::owner_all);
  write_config("");
  const testing::Ended ended = check();
  EXPECT_EQ(ended.status, 4);
  for (const char* node : {"node1", "node2"}) {
    const std::string line = std::string("FAULT node ") + node +
                             ": has build bb of the worker, and this machine has build aa;";
    EXPECT_NE(ended.out.find(line), std::string::npos) << ended.out;
  }
}

TEST_F(ClusterCheck, InstallationFolderThatOthersCanChangeIsAFault) {
  std::filesystem::create_directory_symlink(folder.path(), shared() / "default");
  const testing::Ended ended = check();
  EXPECT_EQ(ended.status, 4);
  const std::string line = "FAULT installation folder: " + (shared() / "default").string() +
                           ": is not a folder, but a link";
  EXPECT_NE(ended.out.find(line), std::string::npos) << ended.out;
}

TEST_F(ClusterCheck, UnknownPartitionIsAFaultWithSlurmsWords) {
  write_config("partition = \"nope\"\n");
  const testing::Ended ended = check();
  EXPECT_EQ(ended.status, 4);
  EXPECT_NE(ended.out.find("FAULT submission: sbatch --test-only: "), std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("Invalid partition name"), std::string::npos) << ended.out;
  EXPECT_TRUE(std::filesystem::is_empty(shared()));
}

TEST_F(ClusterCheck, ControllerThatDoesNotAnswerIsAFaultWithSlurmsWords) {
  cluster->does("kill", "slurmctld");
  const testing::Ended ended = check();
  EXPECT_EQ(ended.status, 4);
  EXPECT_NE(ended.out.find("FAULT Slurm controller: sinfo: "), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("Unable to contact slurm controller"), std::string::npos) << ended.out;
}

TEST_F(ClusterCheck, BusyNodesGetANoteAndTheirJobsAreCancelled) {
  ASSERT_TRUE(keep_nodes_busy());
  const auto scratch = shared() / "check-0";
  std::filesystem::create_directories(scratch);
  std::vector<CheckLine> lines;
  daemon::slurm::CheckCaller caller;
  caller.add = [&](const CheckLine& line) { lines.push_back(line); };
  const auto done = daemon::slurm::check_nodes({shared()}, {worker, "aa", worker},
                                               {{"node1", "idle"}, {"node2", "idle"}}, scratch,
                                               std::chrono::milliseconds(3000), caller);
  ASSERT_TRUE(done) << done.error().message;
  ASSERT_EQ(lines.size(), 2U);
  for (const CheckLine& line : lines) {
    EXPECT_EQ(line.verdict, CheckLine::Verdict::kNote) << line.detail;
    EXPECT_NE(line.detail.find("is busy"), std::string::npos) << line.detail;
  }
  EXPECT_EQ(open_jobs(), "busy RUNNING\n");
}

TEST_F(ClusterCheck, InterruptedCheckLeavesNothing) {
  ASSERT_TRUE(keep_nodes_busy());
  testing::ProcessOptions options;
  options.files = {{STDERR_FILENO, folder.path() / "err"}};
  testing::Process process(command(), options);
  ASSERT_TRUE(wait_until([&] {
    return content(folder.path() / "err").find("waiting for 2 nodes") != std::string::npos;
  }));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait().status, 130);
  EXPECT_EQ(open_jobs(), "busy RUNNING\n");
  EXPECT_TRUE(std::filesystem::is_empty(shared()));
}

TEST_F(ClusterCheck, NodeThatIsDownIsOnlyNamed) {
  (void)Cluster::ask(
      {"/usr/bin/scontrol", "update", "NodeName=node2", "State=DOWN", "Reason=test"});
  const testing::Ended ended = check();
  EXPECT_EQ(ended.status, 0) << ended.out;
  EXPECT_NE(ended.out.find("note  node node2: is down and was not checked"), std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("ok    node node1: "), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace hydroprint::tests
