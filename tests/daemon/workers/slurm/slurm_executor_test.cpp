// SlurmExecutor with programs that answer, fail, print garbage or hang as a test wants.
// cluster_test.cpp runs it with the real Slurm.
#include "daemon/workers/slurm/slurm_executor.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "daemon/platform/durable_file.h"
#include "tests/daemon/workers/slurm/scripted_engine.h"
#include "tests/support/content.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/timing.h"

namespace hydroprint::daemon::slurm {
namespace {

using std::chrono::milliseconds;
using testing::content;
using testing::wait_until;

class SlurmExecutorTest : public ::testing::Test {
 protected:
  static constexpr SlurmExecutor::Pace kPace{milliseconds(20), milliseconds(500), milliseconds(300),
                                             milliseconds(100), milliseconds(200)};

  [[nodiscard]] Settings settings() const {
    Settings out;
    out.folder = folder.path() / "shared";
    out.installation = "lab";
    return out;
  }
  [[nodiscard]] Execution execution(std::int64_t job = 7) const {
    Execution out{job, 1, kSlurmExecutor, "", executor->runs({}) / run_name(job, 1)};
    std::filesystem::create_directories(RunFolder{out.folder}.work());
    std::filesystem::create_directories(RunFolder{out.folder}.inputs());
    return out;
  }
  [[nodiscard]] Execution started(std::int64_t job = 7) {
    const Execution out = execution(job);
    EXPECT_TRUE(executor->start(out, launch));
    return out;
  }
  [[nodiscard]] std::optional<Observation> poll(const Execution& execution) {
    return of_job(executor->poll({execution}), execution.job);
  }
  // Polls until there is an observation of the type.
  template <class Type>
  [[nodiscard]] std::optional<Type> wait_for(const Execution& execution) {
    std::optional<Type> out;
    (void)wait_until([&] {
      const auto seen = poll(execution);
      if (seen && std::holds_alternative<Type>(*seen)) out = std::get<Type>(*seen);
      return out.has_value();
    });
    return out;
  }
  // Polls until the engine was asked twice more; returns whether there was no observation.
  [[nodiscard]] bool is_unknown(const Execution& execution) {
    const auto calls = engine.calls("squeue");
    bool out = true;
    (void)wait_until([&] {
      out = !poll(execution).has_value() && out;
      return engine.calls("squeue") >= calls + 2;
    });
    return out;
  }
  void leave(const Execution& execution, const std::string& file, const std::string& text) const {
    std::ofstream(execution.folder / (file + ".new")) << text;
    std::filesystem::rename(execution.folder / (file + ".new"), execution.folder / file);
  }

  SlurmExecutorTest() {
    std::filesystem::create_directory(settings().folder);
    executor = SlurmExecutor::make(settings(), kPace).value();
  }

  testing::TemporaryFolder folder;
  ScriptedEngine engine{folder.path() / "bin"};
  Launch launch{.program = "/bin/true", .build_id = "ab12", .confined = false};
  std::unique_ptr<SlurmExecutor> executor;
};

TEST_F(SlurmExecutorTest, WaitingReasonIsReported) {
  engine.queue("1|PENDING|Resources|hydroprint-lab-7-1\\n");
  const auto waits = wait_for<WorkerWaits>(started());
  ASSERT_TRUE(waits);
  EXPECT_EQ(waits->reason, "Resources");
}

TEST_F(SlurmExecutorTest, RefusalIsAnErrorWithSlurmsWords) {
  engine.does("sbatch", "echo sbatch: error: invalid partition specified: nope >&2; exit 1");
  const auto refused = executor->start(execution(), launch);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, ErrorReason::WORKER_UNUSABLE);
  EXPECT_NE(refused.error().message.find("invalid partition specified: nope"), std::string::npos);
}

TEST_F(SlurmExecutorTest, SilentSubmissionIsRepeatedOnceSlurmAnswersAndDoesNotKnowTheJob) {
  engine.does("sbatch",
              "echo sbatch: error: Batch job submission failed: Unable to contact slurm controller "
              "'(connect failure)' >&2; exit 1");
  engine.does("squeue", "exit 1");
  const Execution job = started();
  EXPECT_TRUE(is_unknown(job));
  EXPECT_EQ(engine.calls("sbatch"), 1);
  engine.does("sbatch", "echo 5");
  engine.queue("");
  EXPECT_TRUE(wait_until([&] {
    (void)poll(job);
    return engine.calls("sbatch") == 2;
  }));
}

TEST_F(SlurmExecutorTest, HangingSubmissionEndsAndTheJobIsFoundByItsName) {
  engine.does("sbatch", "exec sleep 60");
  const auto begin = testing::Clock::now();
  const Execution job = started();
  EXPECT_LT(testing::seconds_since(begin), 30);
  engine.queue("1|RUNNING|None|hydroprint-lab-7-1\\n");
  EXPECT_TRUE(wait_for<WorkerWaits>(job)) << "not begun yet";
  std::filesystem::create_directory(job.folder / "begun");
  EXPECT_TRUE(wait_for<WorkerRuns>(job));
  EXPECT_EQ(engine.calls("sbatch"), 1);
}

TEST_F(SlurmExecutorTest, IdThatIsGarbageIsNotNeeded) {
  engine.does("sbatch", "echo all is well");
  const Execution job = execution();
  const auto handle = executor->start(job, launch);
  ASSERT_TRUE(handle);
  EXPECT_EQ(*handle, "");
  engine.queue("1|PENDING|Priority|hydroprint-lab-7-1\\n");
  EXPECT_TRUE(wait_for<WorkerWaits>(job));
}

TEST_F(SlurmExecutorTest, GarbageFailureOrSilenceOfTheQueueMeansNothing) {
  const Execution job = started();
  for (const char* bad : {"echo '{'", "exit 1", "exec sleep 60", "kill -9 $$",
                          "printf '1|RUNNING|None|hydroprint-lab-7-1'"}) {
    engine.does("squeue", bad);
    EXPECT_TRUE(is_unknown(job)) << bad;
  }
}

TEST_F(SlurmExecutorTest, ExitFileIsTheTruthWhateverSlurmSays) {
  const Execution job = started();
  for (const char* word : {"exit 1", "printf '1|RUNNING|None|hydroprint-lab-7-1\\n'",
                           "printf '1|NODE_FAIL|None|hydroprint-lab-7-1\\n'"}) {
    engine.does("squeue", word);
    leave(job, "exit", "3\n");
    leave(job, "errors", "a word\n");
    const auto end = wait_for<WorkerEnds>(job);
    ASSERT_TRUE(end) << word;
    EXPECT_EQ(end->wait_status, 3 << 8);
    EXPECT_EQ(end->errors, "a word\n");
    EXPECT_FALSE(end->exceeded_time);
  }
}

TEST_F(SlurmExecutorTest, SlurmSaysWhyASignalEndedTheWorker) {
  for (const auto& [state, is_time, is_memory] :
       {std::tuple("TIMEOUT", true, false), std::tuple("OUT_OF_MEMORY", false, true),
        std::tuple("FAILED", false, false)}) {
    const Execution job = started();
    engine.queue("1|COMPLETING|None|hydroprint-lab-7-1\\n");
    leave(job, "exit", "130\n");
    EXPECT_TRUE(is_unknown(job)) << "not final yet";
    engine.queue(std::string("1|") + state + "|None|hydroprint-lab-7-1\\n");
    const auto end = wait_for<WorkerEnds>(job);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->exceeded_time, is_time) << state;
    EXPECT_EQ(end->exceeded_memory, is_memory) << state;
    std::filesystem::remove(job.folder / "exit");
  }
}

TEST_F(SlurmExecutorTest, LimitThatLeftNoExitFileIsKnownFromSlurm) {
  const Execution job = started();
  engine.queue("1|TIMEOUT|TimeLimit|hydroprint-lab-7-1\\n");
  const auto end = wait_for<WorkerEnds>(job);
  ASSERT_TRUE(end);
  EXPECT_TRUE(end->exceeded_time);
}

TEST_F(SlurmExecutorTest, UnknownJobIsGoneOnlyAfterTheWaitForItsExitFile) {
  const Execution job = started();
  std::filesystem::create_directory(job.folder / "begun");
  engine.queue("");
  EXPECT_TRUE(is_unknown(job));
  const auto begin = testing::Clock::now();
  EXPECT_TRUE(wait_for<WorkerIsGone>(job));
  EXPECT_GT(testing::seconds_since(begin), 0.1);
}

TEST_F(SlurmExecutorTest, JobThatSlurmRemembersAgainIsNotGone) {
  const Execution job = started();
  std::filesystem::create_directory(job.folder / "begun");
  engine.queue("");
  EXPECT_TRUE(is_unknown(job));
  engine.queue("1|RUNNING|None|hydroprint-lab-7-1\\n");
  EXPECT_TRUE(wait_for<WorkerRuns>(job));
  engine.queue("");
  EXPECT_TRUE(is_unknown(job)) << "the wait begins again";
}

TEST_F(SlurmExecutorTest, CancelledJobThatWaitedIsGoneAtOnce) {
  const Execution job = started();
  engine.queue("1|PENDING|Resources|hydroprint-lab-7-1\\n");
  EXPECT_TRUE(wait_for<WorkerWaits>(job));
  EXPECT_TRUE(executor->cancel(job, CancelHow::kGently));
  EXPECT_NE(content(folder.path() / "bin/scancel.calls").find("--name=hydroprint-lab-7-1"),
            std::string::npos);
  engine.queue("1|CANCELLED|Resources|hydroprint-lab-7-1\\n");
  EXPECT_TRUE(wait_for<WorkerIsGone>(job));
}

TEST_F(SlurmExecutorTest, CancelThatSlurmDoesNotAnswerIsAnError) {
  const Execution job = started();
  engine.does("scancel", "echo scancel: error: no >&2; exit 8");
  EXPECT_FALSE(executor->cancel(job, CancelHow::kGently));
}

TEST_F(SlurmExecutorTest, ProgressNeedsNoWordOfSlurm) {
  const Execution job = started();
  engine.does("squeue", "exit 1");
  std::ofstream(progress_file({job.folder})) << "one\ntwo\n";
  const auto runs = wait_for<WorkerRuns>(job);
  ASSERT_TRUE(runs);
  EXPECT_EQ(runs->progress, (std::vector<std::string>{"one", "two"}));
}

TEST_F(SlurmExecutorTest, AllJobsShareOneQueryAtATime) {
  auto pace = kPace;
  pace.between_queries = std::chrono::hours(1);
  executor.reset();
  executor = SlurmExecutor::make(settings(), pace).value();
  std::vector<Execution> jobs;
  for (std::int64_t job = 1; job <= 20; ++job) jobs.push_back(started(job));
  const auto before = engine.calls("squeue");
  for (int i = 0; i < 50; ++i) (void)executor->poll(jobs);
  EXPECT_TRUE(wait_until([&] {
    (void)executor->poll(jobs);
    return executor->descriptors().empty();
  }));
  EXPECT_EQ(engine.calls("squeue"), before + 1);
}

TEST_F(SlurmExecutorTest, AdoptsWhatSlurmKnowsOrWhatHasBegun) {
  engine.queue("1|RUNNING|None|hydroprint-lab-7-1\\n");
  const Execution known = started(7), begun = started(8), ended = started(9);
  std::filesystem::create_directory(begun.folder / "begun");
  leave(ended, "exit", "0\n");
  executor.reset();
  executor = SlurmExecutor::make(settings(), kPace).value();
  for (const Execution& job : {known, begun, ended}) {
    EXPECT_EQ(executor->adopt(job), Adoption::kAdopted) << job.job;
  }
  const auto end = wait_for<WorkerEnds>(ended);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->wait_status, 0);
}

TEST_F(SlurmExecutorTest, OffersWhatSlurmDoesNotKnowForAWhileBeforeItIsGone) {
  const Execution job = started();
  executor.reset();
  executor = SlurmExecutor::make(settings(), kPace).value();
  EXPECT_EQ(executor->adopt(job), Adoption::kNoAnswer);
  EXPECT_TRUE(wait_until([&] { return executor->adopt(job) == Adoption::kGone; }));
}

TEST_F(SlurmExecutorTest, SilentSlurmDoesNotMakeAJobGone) {
  engine.does("squeue", "exit 1");
  const Execution job = started();
  executor.reset();
  executor = SlurmExecutor::make(settings(), kPace).value();
  (void)executor->adopt(job);
  const auto calls = engine.calls("squeue");
  EXPECT_TRUE(wait_until([&] {
    EXPECT_EQ(executor->adopt(job), Adoption::kNoAnswer);
    return engine.calls("squeue") > calls + 20;  // longer than the wait for an exit file
  }));
}

TEST_F(SlurmExecutorTest, JobThatWasNeverHandedOverIsGone) {
  executor.reset();
  executor = SlurmExecutor::make(settings(), kPace).value();
  EXPECT_EQ(executor->adopt(execution()), Adoption::kGone);
}

TEST_F(SlurmExecutorTest, FolderThatIsNotMountedIsNoAnswer) {
  executor.reset();
  executor = SlurmExecutor::make(settings(), kPace).value();  // its own folder is not new
  Execution job = execution();
  job.folder = folder.path() / "not mounted" / "lab" / "7-1";
  EXPECT_EQ(executor->adopt(job), Adoption::kNoAnswer);
}

TEST_F(SlurmExecutorTest, FoldersOfEndedExecutionsAreDeleted) {
  const Execution kept = started(7), other = started(8);
  executor->keep_only({kept});
  EXPECT_TRUE(std::filesystem::exists(kept.folder));
  EXPECT_FALSE(std::filesystem::exists(other.folder));
}

TEST_F(SlurmExecutorTest, SubmissionThatFailsForAWhileIsRepeatedWithSlurmsWords) {
  engine.queue("");
  for (const char* words :
       {"Batch job submission failed: Unable to contact slurm controller (connect failure)",
        "Batch job submission failed: Connection reset by peer",
        "Batch job submission failed: Transport endpoint is not connected",
        "Batch job submission failed: Job violates accounting/QOS policy (job submit limit)"}) {
    engine.does("sbatch", std::string("echo 'sbatch: error: ") + words + "' >&2; exit 1");
    const Execution job = execution();
    ASSERT_TRUE(executor->start(job, launch)) << words;
    const auto waits = wait_for<WorkerWaits>(job);
    ASSERT_TRUE(waits) << words;
    EXPECT_NE(waits->reason.find(words), std::string::npos) << waits->reason;
  }
}

TEST_F(SlurmExecutorTest, JobThatIsAcceptedButNeverSeenFailsInsteadOfFloodingSlurm) {
  engine.does("sbatch", "echo all is well");
  engine.queue("");
  const auto end = wait_for<WorkerEnds>(started());
  ASSERT_TRUE(end);
  EXPECT_NE(end->errors.find("squeue does not show"), std::string::npos) << end->errors;
  EXPECT_LE(engine.calls("sbatch"), 6);
}

// The pool's thread makes all calls, and has other jobs to look after.
TEST_F(SlurmExecutorTest, HangingProgramsDelayManyJobsOnlyOnce) {
  auto pace = kPace;
  pace.pause = std::chrono::hours(1);
  executor.reset();
  executor = SlurmExecutor::make(settings(), pace).value();
  engine.does("sbatch", "exec sleep 60");
  engine.does("scancel", "exec sleep 60");
  engine.queue("");
  std::vector<Execution> jobs;
  for (std::int64_t job = 1; job <= 16; ++job) jobs.push_back(started(job));
  (void)wait_until([&] {
    (void)executor->poll(jobs);
    return engine.calls("squeue") > 5;
  });
  for (const Execution& job : jobs) EXPECT_FALSE(executor->cancel(job, CancelHow::kGently));
  EXPECT_EQ(engine.calls("sbatch") + engine.calls("scancel"), 1);
}

TEST_F(SlurmExecutorTest, QueryThatOutlastsTheLastJobIsTakenUp) {
  engine.does("squeue", "sleep 0.2");
  const Execution job = started();
  ASSERT_TRUE(wait_until([&] {
    (void)poll(job);
    return !executor->descriptors().empty();
  }));
  EXPECT_TRUE(wait_until([&] {
    (void)executor->poll({});
    return executor->descriptors().empty();
  })) << "otherwise the caller's poll() would return at once, again and again";
}

TEST_F(SlurmExecutorTest, CrashNeedsNoWordOfSlurm) {
  engine.does("squeue", "exit 1");
  const Execution job = started();
  leave(job, "exit", std::to_string(128 + SIGSEGV) + "\n");
  const auto end = wait_for<WorkerEnds>(job);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->wait_status, SIGSEGV);
}

TEST_F(SlurmExecutorTest, WorkerThatSlurmTookBackIsGoneAndRunsAgain) {
  for (const char* state : {"PREEMPTED", "NODE_FAIL"}) {
    const Execution job = started();
    engine.queue(std::string("1|") + state + "|None|hydroprint-lab-7-1\\n");
    leave(job, "exit", "130\n");
    EXPECT_TRUE(wait_for<WorkerIsGone>(job)) << state;
    std::filesystem::remove(job.folder / "exit");
  }
}

// What a worker left behind on a node may write for ever.
TEST_F(SlurmExecutorTest, ProgressDoesNotKeepACancelledJobAlive) {
  const Execution job = started();
  std::filesystem::create_directory(job.folder / "begun");
  EXPECT_TRUE(executor->cancel(job, CancelHow::kGently));
  engine.queue("1|CANCELLED|None|hydroprint-lab-7-1\\n");
  std::ofstream progress(progress_file({job.folder}));
  EXPECT_TRUE(wait_until([&] {
    progress << "{}\n" << std::flush;
    const auto seen = poll(job);
    return seen && std::holds_alternative<WorkerIsGone>(*seen);
  }));
}

TEST_F(SlurmExecutorTest, SharedFolderThatIsNotMountedMakesNoJobGone) {
  const Execution job = started();
  executor.reset();
  std::filesystem::rename(folder.path() / "shared", folder.path() / "aside");
  EXPECT_FALSE(SlurmExecutor::make(settings(), kPace)) << "the folder does not exist";
  std::filesystem::create_directory(folder.path() / "shared");  // the place where it is mounted
  executor = SlurmExecutor::make(settings(), kPace).value();
  engine.queue("");
  const auto calls = engine.calls("squeue");
  EXPECT_TRUE(wait_until([&] {
    EXPECT_EQ(executor->adopt(job), Adoption::kNoAnswer);
    (void)executor->poll({});
    return engine.calls("squeue") > calls + 20;
  }));
}

TEST_F(SlurmExecutorTest, JobCancelledWhileNoDaemonRanIsGoneAtOnce) {
  const Execution job = started();
  executor.reset();
  auto pace = kPace;
  pace.exit_file = std::chrono::hours(1);
  executor = SlurmExecutor::make(settings(), pace).value();
  engine.queue("1|CANCELLED|Resources|hydroprint-lab-7-1\\n");
  EXPECT_TRUE(wait_until([&] { return executor->adopt(job) == Adoption::kGone; }));
}

TEST_F(SlurmExecutorTest, UnknownJobsOfTheInstallationAreEnded) {
  const Execution kept = started(7);
  engine.queue(
      "1|RUNNING|None|hydroprint-lab-7-1\\n2|PENDING|None|hydroprint-lab-8-1\\n"
      "3|RUNNING|None|hydroprint-lab2-9-1\\n4|RUNNING|None|other\\n");
  executor->keep_only({kept});
  (void)started(10);
  EXPECT_TRUE(wait_until([&] {
    (void)executor->poll({kept});
    return engine.calls("scancel") >= 1;
  }));
  EXPECT_FALSE(is_unknown(kept)) << "two more queries";
  EXPECT_EQ(engine.calls("scancel"), 1);
  EXPECT_NE(content(folder.path() / "bin/scancel.calls").find("--name=hydroprint-lab-8-1\n"),
            std::string::npos);
}

TEST_F(SlurmExecutorTest, IsNotReadyOnceAnotherDaemonHasTakenTheFolder) {
  EXPECT_TRUE(executor->ready());
  std::ofstream(folder.path() / "shared/lab/lock") << "elsewhere 1 boot:1 token\n";
  (void)executor->poll({});  // the first heartbeat
  const Status lost = executor->ready();
  ASSERT_FALSE(lost);
  EXPECT_NE(lost.error().message.find("elsewhere"), std::string::npos) << lost.error().message;
}

TEST_F(SlurmExecutorTest, IsNotReadyWhileTheSharedFolderIsFull) {
  const auto lab = folder.path() / "shared/lab";
  if (::mount("none", lab.c_str(), "tmpfs", 0, "size=64k") != 0) {
    GTEST_SKIP() << "cannot mount a small disk: " << std::strerror(errno) << " (needs root)";
  }
  const Status full = executor->ready();
  ::umount2(lab.c_str(), MNT_DETACH);
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().reason, ErrorReason::DISK_FULL) << full.error().message;
  EXPECT_TRUE(executor->ready());
}

TEST_F(SlurmExecutorTest, SecondDaemonOfAnInstallationIsRefused) {
  const auto second = SlurmExecutor::make(settings(), kPace);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("workers.slurm.installation"), std::string::npos);
}

TEST_F(SlurmExecutorTest, MissingProgramIsNamed) {
  executor.reset();
  ::setenv("PATH", "/nowhere", 1);
  const auto without = SlurmExecutor::make(settings(), kPace);
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().message.find("sbatch"), std::string::npos) << without.error().message;
}

}  // namespace
}  // namespace hydroprint::daemon::slurm
