// Runs the script of an execution with the real shell, without Slurm.
#include "daemon/workers/slurm/script.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "daemon/platform/durable_file.h"
#include "daemon/workers/slurm/run_files.h"
#include "daemon/workers/worker_outcome.h"
#include "tests/support/content.h"
#include "tests/support/process.h"

namespace hydroprint::daemon::slurm {
namespace {

using hydroprint::testing::content;

class SlurmScript : public ::testing::Test {
 protected:
  SlurmScript() {
    std::filesystem::create_directories(run.inputs());
    std::filesystem::create_directories(run.work());
    std::ofstream(worker) << "#!/bin/sh\necho '{\"version\": \"1\", \"build_id\": \"ab12\"}'\n";
    std::filesystem::permissions(worker, std::filesystem::perms::owner_all);
  }
  [[nodiscard]] std::vector<std::string> command_line(const std::string& shell_command,
                                                      const std::string& build_id = "ab12") const {
    const ScriptPlan plan{
        {"--time=1"}, run.root, worker, build_id, {"/bin/sh", "-c", shell_command}, run.inputs()};
    std::ofstream(script_file(run)) << batch_script(plan);
    return {"/bin/sh", script_file(run)};
  }
  // Returns how the worker ended.
  [[nodiscard]] int ended(const std::string& shell_command, const std::string& build_id = "ab12") {
    (void)testing::run(command_line(shell_command, build_id));
    return wait_status(run).value_or(-1);
  }

  testing::TemporaryFolder folder;
  RunFolder run{folder.path() / "it's 7-1 $(touch x)"};
  std::filesystem::path worker = folder.path() / "the worker's program";
};

TEST_F(SlurmScript, LeavesOutputAndStatus) {
  EXPECT_FALSE(has_begun(run));
  EXPECT_FALSE(wait_status(run));
  EXPECT_EQ(ended("pwd; echo words >&2; exit 3"), 3 << 8);
  EXPECT_TRUE(has_begun(run));
  EXPECT_EQ(answer_of(run), run.inputs().string() + "\n");
  EXPECT_EQ(errors_of(run), "words\n");
}

TEST_F(SlurmScript, SuccessIsZero) { EXPECT_EQ(ended("exit 0"), 0); }

TEST_F(SlurmScript, SignalIsKnownFromTheStatus) {
  EXPECT_EQ(ended("kill -KILL $$"), SIGKILL);
  std::filesystem::remove(run.root / "begun");
  EXPECT_EQ(ended("kill -SEGV $$"), SIGSEGV);
  std::filesystem::remove(run.root / "begun");
  EXPECT_EQ(ended("exit 130"), 130 << 8) << "a worker that was cancelled";
}

TEST_F(SlurmScript, SecondRunEndsAtOnceAndLeavesEverything) {
  EXPECT_EQ(ended("echo first"), 0);
  EXPECT_NE(testing::run(command_line("echo second")).status, 0);
  EXPECT_EQ(answer_of(run), "first\n");
}

TEST_F(SlurmScript, WithoutItsFolderNothingRuns) {
  const auto command = command_line("touch ../../ran");
  const auto aside = folder.path() / "script";
  std::filesystem::rename(script_file(run), aside);
  std::filesystem::remove_all(run.root);
  EXPECT_NE(testing::run({"/bin/sh", aside}).status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "ran"));
}

TEST_F(SlurmScript, OtherBuildOfTheWorkerIsRefusedBeforeAnyWork) {
  const int status = ended("touch ../ran", "cd34");
  EXPECT_FALSE(std::filesystem::exists(run.root / "ran"));
  const auto failure = judge(status, StopReason::kNothing, errors_of(run), answer_of(run));
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->error.reason, ErrorReason::WORKER_DIFFERS);
  for (const char* id : {"ab12", "cd34"}) {
    EXPECT_NE(failure->error.message.find(id), std::string::npos) << failure->error.message;
  }
}

TEST_F(SlurmScript, WorkerThatIsNotInstalledIsRefused) {
  std::filesystem::remove(worker);
  const int status = ended("touch ../ran");
  EXPECT_FALSE(std::filesystem::exists(run.root / "ran"));
  const auto failure = judge(status, StopReason::kNothing, errors_of(run), answer_of(run));
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->error.reason, ErrorReason::WORKER_DIFFERS);
}

// Slurm sends SIGTERM to the script and to the worker.
TEST_F(SlurmScript, TerminatedScriptWaitsForItsWorker) {
  const auto command =
      command_line("trap 'sleep 0.2; exit 130' TERM; touch ../ready; while :; do sleep 0.01; done");
  testing::Process process(command);
  ASSERT_TRUE(testing::wait_until([&] { return std::filesystem::exists(run.root / "ready"); }));
  const std::string children = content("/proc/" + std::to_string(process.pid()) + "/task/" +
                                       std::to_string(process.pid()) + "/children");
  process.signal(SIGTERM);
  ::kill(std::stoi(children), SIGTERM);
  process.wait();
  EXPECT_EQ(wait_status(run), 130 << 8);
}

TEST_F(SlurmScript, TerminatedBeforeItsWorkItDoesNotWork) {
  std::ofstream(worker) << "#!/bin/sh\ntouch '" << folder.path().string() << "/asked'\nsleep 0.3\n";
  testing::Process process(command_line("touch ../ran"));
  ASSERT_TRUE(
      testing::wait_until([&] { return std::filesystem::exists(folder.path() / "asked"); }));
  process.signal(SIGTERM);
  process.wait();
  EXPECT_EQ(wait_status(run), SIGTERM);
  EXPECT_FALSE(std::filesystem::exists(run.root / "ran"));
}

TEST_F(SlurmScript, FullFolderIsReportedAsSuch) {
  const auto command = command_line("head -c 1000000 /dev/zero > ../work/out; exit 4");
  const std::string script = content(script_file(run));
  if (::mount("none", run.root.c_str(), "tmpfs", 0, "size=64k") != 0) {
    GTEST_SKIP() << "cannot mount a small disk: " << std::strerror(errno) << " (needs root)";
  }
  std::filesystem::create_directories(run.inputs());
  std::filesystem::create_directories(run.work());
  std::ofstream(folder.path() / "script") << script;
  (void)testing::run({"/bin/sh", folder.path() / "script"});
  const auto failure =
      judge(wait_status(run).value_or(0), StopReason::kNothing, errors_of(run), answer_of(run));
  ::umount2(run.root.c_str(), MNT_DETACH);
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->error.reason, ErrorReason::DISK_FULL) << failure->error.message;
}

TEST_F(SlurmScript, OptionsComeBeforeTheFirstCommand) {
  (void)command_line("true");
  EXPECT_TRUE(content(script_file(run)).starts_with("#!/bin/sh\n#SBATCH --time=1\n"));
}

TEST(SlurmRunFiles, ExitFileThatIsNotCompleteIsIgnored) {
  const testing::TemporaryFolder folder;
  for (const char* text : {"", "1", "x\n", "-1\n", "999\n", "\n"}) {
    std::ofstream(folder.path() / "exit") << text;
    EXPECT_FALSE(wait_status({folder.path()})) << text;
  }
}

TEST(SlurmRunFiles, ProgressIsReadOnceAndInWholeLines) {
  const testing::TemporaryFolder folder;
  const RunFolder run{folder.path()};
  std::filesystem::create_directories(run.work());
  ProgressReader reader;
  EXPECT_TRUE(reader.lines(run).empty());
  std::ofstream file(progress_file(run));
  file << "one\ntw" << std::flush;
  EXPECT_EQ(reader.lines(run), std::vector<std::string>{"one"});
  file << "o\nthree\n" << std::flush;
  EXPECT_EQ(reader.lines(run), (std::vector<std::string>{"two", "three"}));
  EXPECT_TRUE(reader.lines(run).empty());
}

// The worker can write to its folder what it likes.
TEST(SlurmRunFiles, ProgressThatIsNotAFileIsIgnored) {
  const testing::TemporaryFolder folder;
  const RunFolder run{folder.path()};
  std::filesystem::create_directories(run.work());
  ASSERT_EQ(::mkfifo(progress_file(run).c_str(), 0600), 0);
  ProgressReader reader;
  EXPECT_TRUE(reader.lines(run).empty());
  std::filesystem::remove(progress_file(run));
  std::filesystem::create_symlink("/proc/self/status", progress_file(run));
  EXPECT_TRUE(reader.lines(run).empty());
}

}  // namespace
}  // namespace hydroprint::daemon::slurm
