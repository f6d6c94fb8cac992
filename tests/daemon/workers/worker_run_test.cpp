// WorkerRun as the judge of what an executor reports; no process is involved.
#include "daemon/workers/worker_run.h"

#include <gtest/gtest.h>
#include <signal.h>

#include "daemon/workers/local_executor.h"
#include "tests/daemon/store/store_fixture.h"
#include "tests/support/paths.h"

namespace hydroprint::daemon {
namespace {

/// An executor that accepts everything, and notes how it was asked to end the worker.
class NotingExecutor : public WorkerExecutor {
 public:
  [[nodiscard]] std::string name() const override { return "noting"; }
  [[nodiscard]] bool outlives_daemon() const override { return true; }
  [[nodiscard]] int capacity() const override { return 1; }
  [[nodiscard]] Result<std::string> start(const Execution&, const Launch&) override { return "h"; }
  [[nodiscard]] Observations poll(const std::vector<Execution>&) override { return {}; }
  [[nodiscard]] Status cancel(const Execution&, CancelHow how) override {
    cancels.push_back(how);
    return {};
  }
  [[nodiscard]] Adoption adopt(const Execution&) override { return Adoption::kNoAnswer; }

  std::vector<CancelHow> cancels;
};

class WorkerRunTest : public StoreTest {
 protected:
  void start(RunLimits limits) {
    id = add().id;
    ASSERT_TRUE(jobs->start(id, executor.name()));
    Launch launch;
    launch.inputs = layout.run(id).inputs();
    run = WorkerRun::start(jobs->get(id).value(), jobs->executions()->front(), launch,
                           {executor, layout, limits, [] {}})
              .value();
  }
  bool step(const std::optional<Observation>& seen) { return run->step(seen, *jobs, now_ms); }
  [[nodiscard]] Job job() { return jobs->get(id).value(); }

  NotingExecutor executor;
  std::int64_t id = 0;
  std::unique_ptr<WorkerRun> run;
};

TEST_F(WorkerRunTest, WaitingAtTheEngineDoesNotUseUpTheTimeLimit) {
  start({std::chrono::seconds(0)});
  EXPECT_FALSE(step(WorkerWaits{"Resources"}));
  EXPECT_EQ(job().progress.phase, "waiting: Resources");
  EXPECT_TRUE(executor.cancels.empty());
  EXPECT_FALSE(step(WorkerRuns{}));
  EXPECT_EQ(executor.cancels, std::vector<CancelHow>{CancelHow::kGently});
  EXPECT_TRUE(step(WorkerEnds{.wait_status = SIGTERM}));
  EXPECT_EQ(job().failure->error.reason, "TIME_LIMIT");
}

TEST_F(WorkerRunTest, NoAnswerChangesNothingBeforeTheLimit) {
  start({std::chrono::seconds(0)});
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(step(std::nullopt));
  EXPECT_EQ(job().state, JobState::kRunning);
  EXPECT_TRUE(executor.cancels.empty());
}

TEST_F(WorkerRunTest, NoAnswerForTooLongFailsTheJob) {
  start({std::chrono::seconds(60), std::chrono::milliseconds(0)});
  EXPECT_TRUE(step(std::nullopt));
  EXPECT_EQ(job().failure->error.reason, "WORKER_UNUSABLE");
}

TEST_F(WorkerRunTest, ExceededMemoryIsTheLimitAndNotAKill) {
  start({std::chrono::seconds(60)});
  EXPECT_TRUE(step(WorkerEnds{.wait_status = SIGKILL, .exceeded_memory = true}));
  EXPECT_EQ(job().failure->error.reason, "MEMORY_LIMIT");
  EXPECT_FALSE(std::filesystem::exists(layout.run(id).root));
}

TEST_F(WorkerRunTest, WorkerThatIsGoneAfterACancelIsCancelled) {
  start({std::chrono::seconds(60)});
  ASSERT_TRUE(jobs->cancel(id));
  run->stop(StopReason::kCancel);
  EXPECT_TRUE(step(WorkerIsGone()));
  EXPECT_EQ(job().state, JobState::kCancelled);
}

TEST_F(WorkerRunTest, WorkerThatIsGoneIsQueuedAgain) {
  start({std::chrono::seconds(60)});
  EXPECT_TRUE(step(WorkerIsGone()));
  EXPECT_EQ(job().state, JobState::kQueued);
}

TEST_F(WorkerRunTest, LocalWorkersEndWithTheirExecutorAndAreNotAdopted) {
  const Execution execution{7, 1, kLocalExecutor, "", folder.path()};
  Launch sleep{.program = "/bin/sh", .arguments = {"-c", "exec sleep 60"}};
  sleep.confine_program = testing::program_path("hydroprint-confine");
  sleep.inputs = sleep.work = folder.path();
  sleep.limits = {.cpu_s = 10, .file_bytes = 1 << 20};
  pid_t pid = 0;
  {
    LocalExecutor local(1);
    EXPECT_EQ(local.adopt(execution), Adoption::kGone);
    pid = std::stoi(local.start(execution, sleep).value());
    EXPECT_TRUE(std::holds_alternative<WorkerRuns>(local.poll({execution}).at(7)));
    EXPECT_EQ(local.adopt(execution), Adoption::kAdopted) << "by the same executor";
  }
  EXPECT_NE(::kill(pid, 0), 0);
  LocalExecutor next(1);
  EXPECT_EQ(next.adopt(execution), Adoption::kGone);
  EXPECT_TRUE(std::holds_alternative<WorkerIsGone>(next.poll({execution}).at(7)));
}

}  // namespace
}  // namespace hydroprint::daemon
