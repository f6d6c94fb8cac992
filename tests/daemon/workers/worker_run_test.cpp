// WorkerRun as the judge of what an executor reports; no process is involved.
#include "daemon/workers/worker_run.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <future>

#include "daemon/platform/durable_file.h"
#include "daemon/store/to_proto.h"
#include "daemon/workers/local_executor.h"
#include "tests/daemon/store/store_fixture.h"
#include "tests/support/content.h"
#include "tests/support/paths.h"
#include "tests/support/timing.h"

namespace hydroprint::daemon {
namespace {

/// An executor that accepts everything, and notes how it was asked to end the worker.
class NotingExecutor : public WorkerExecutor {
 public:
  [[nodiscard]] std::string name() const override { return "noting"; }
  [[nodiscard]] bool outlives_daemon() const override { return true; }
  [[nodiscard]] int capacity() const override { return 1; }
  [[nodiscard]] Result<std::string> start(const Execution&, const Launch& launch) override {
    started_with.emplace(launch);
    if (refuses) return fail(Code::kInternal, "refused", ErrorReason::WORKER_UNUSABLE);
    return "h";
  }
  [[nodiscard]] Observations poll(const std::vector<Execution>&) override { return {}; }
  [[nodiscard]] Status cancel(const Execution&, CancelHow how) override {
    cancels.push_back(how);
    return {};
  }
  [[nodiscard]] Adoption adopt(const Execution&) override { return Adoption::kNoAnswer; }

  std::vector<CancelHow> cancels;
  std::optional<Launch> started_with;
  bool refuses = false;
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
  EXPECT_EQ(job().progress.waits_for, "Resources");
  EXPECT_EQ(job().progress.phase, "");
  EXPECT_TRUE(executor.cancels.empty());
  EXPECT_FALSE(step(WorkerRuns{}));
  EXPECT_EQ(executor.cancels, std::vector<CancelHow>{CancelHow::kGently});
  EXPECT_TRUE(step(WorkerEnds{.wait_status = SIGTERM}));
  EXPECT_EQ(job().failure->error.reason, ErrorReason::TIME_LIMIT);
}

TEST_F(WorkerRunTest, CancelledJobDoesNotShowAsWaiting) {
  start({std::chrono::seconds(60)});
  EXPECT_FALSE(step(WorkerWaits{"Resources"}));
  EXPECT_EQ(to_message(job()).waits_for(), "Resources");
  ASSERT_TRUE(jobs->cancel(id));
  EXPECT_EQ(to_message(job()).waits_for(), "");
}

TEST_F(WorkerRunTest, RefusedInputNamesTheFieldOfTheJob) {
  start({std::chrono::seconds(60)});
  EXPECT_TRUE(step(WorkerEnds{.wait_status = 3 << 8,
                              .answer = R"({"error":{"message":"too large","field":"dpi"}})"}));
  EXPECT_EQ(to_message(job()).error().field(), "simulate.dpi");
  EXPECT_EQ(to_message(job()).error().message(), "too large");
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
  EXPECT_EQ(job().failure->error.reason, ErrorReason::WORKER_UNUSABLE);
}

TEST_F(WorkerRunTest, ExceededMemoryIsTheLimitAndNotAKill) {
  start({std::chrono::seconds(60)});
  EXPECT_TRUE(step(WorkerEnds{.wait_status = SIGKILL, .exceeded_memory = true}));
  EXPECT_EQ(job().failure->error.reason, ErrorReason::MEMORY_LIMIT);
  EXPECT_FALSE(std::filesystem::exists(layout.run(id).root));
}

TEST_F(WorkerRunTest, ExceededOutputIsTheLimitAndNotAKill) {
  start({std::chrono::seconds(60)});
  EXPECT_TRUE(step(WorkerEnds{.wait_status = SIGKILL, .exceeded_output = true}));
  EXPECT_EQ(job().failure->error.reason, ErrorReason::OUTPUT_LIMIT);
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

/// A worker that left a sparse file, which would be hashed for an hour.
class EndlessPublishing : public WorkerRunTest {
 protected:
  void SetUp() override {
    constexpr std::int64_t kTiB = 1LL << 40;
    start({std::chrono::seconds(60), kMostSilence, {kTiB, kTiB}});
    const auto out = layout.run(id).out();
    std::filesystem::create_directories(out);
    std::ofstream(out / "film.png") << "";
    ASSERT_EQ(::truncate((out / "film.png").c_str(), kTiB), 0);
    EXPECT_FALSE(step(WorkerEnds{}));
    EXPECT_EQ(job().state, JobState::kRunning);
  }
};

TEST_F(EndlessPublishing, EndsOnCancel) {
  ASSERT_TRUE(jobs->cancel(id));
  run->stop(StopReason::kCancel);
  EXPECT_TRUE(testing::wait_until([&] { return step(std::nullopt); }));
  EXPECT_EQ(job().state, JobState::kCancelled);
  EXPECT_FALSE(std::filesystem::exists(layout.run(id).root));
}

TEST_F(EndlessPublishing, EndsWithTheDaemonAndLeavesTheJobOpen) {
  run->stop(StopReason::kShutdown);
  EXPECT_TRUE(step(std::nullopt));
  run.reset();
  EXPECT_EQ(job().state, JobState::kRunning);
  EXPECT_EQ(jobs->executions()->size(), 1U);
}

TEST_F(EndlessPublishing, EndsWithADaemonThatTheWorkerOutlives) {
  const auto root = run->execution().folder;
  run.reset();
  EXPECT_TRUE(std::filesystem::exists(root)) << "the next daemon publishes it";
}

TEST_F(WorkerRunTest, OutputThatIsALinkToItselfFailsTheJob) {
  start({std::chrono::seconds(60)});
  std::filesystem::create_directories(layout.run(id).work());
  std::filesystem::create_symlink("out", layout.run(id).out());
  const bool is_over = step(WorkerEnds{});
  EXPECT_TRUE(is_over || testing::wait_until([&] { return step(std::nullopt); }));
  EXPECT_EQ(job().failure->error.reason, ErrorReason::WORKER_UNUSABLE);
}

/// The folder of the run is on another file system, and an input whose copy ends when somebody
/// opens it for writing.
class SlowShare : public WorkerRunTest {
 protected:
  void SetUp() override {
    const auto asset = layout.asset(kSha256);
    std::filesystem::create_directories(asset.parent_path());
    ASSERT_EQ(::mkfifo(asset.c_str(), 0600), 0);
    std::string name = "/dev/shm/hydroprint-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) GTEST_SKIP() << "no /dev/shm";
    share = name;
    struct stat here {};
    struct stat there {};
    ASSERT_EQ(::stat(folder.path().c_str(), &here) + ::stat(name.c_str(), &there), 0);
    if (here.st_dev == there.st_dev) GTEST_SKIP() << "/dev/shm is the same file system";
    begin();
  }
  void TearDown() override {
    release();
    run.reset();
    std::filesystem::remove_all(share);
  }

  void begin() {
    id = add().id;
    ASSERT_TRUE(jobs->start(id, executor.name(), share));
    Job copied = job();
    copied.definition.work.inputs = {{"model.obj", kSha256}};
    const Execution execution = jobs->executions()->front();
    Launch launch;
    launch.inputs = RunFolder{execution.folder}.inputs();
    run = WorkerRun::start(
              copied, execution, launch,
              {executor, layout, {std::chrono::seconds(60)}, [this] { woken.set_value(); }})
              .value();
  }
  void release() {
    if (is_released || !run) return;
    is_released = true;
    ::close(::open(layout.asset(kSha256).c_str(), O_WRONLY));  // waits for the reader
    woken.get_future().wait();
  }

  const std::string kSha256 = sha256("");  // a pipe has no bytes to copy
  std::filesystem::path share;
  std::promise<void> woken;
  bool is_released = false;
};

TEST_F(SlowShare, WorkerStartsWhenItsFilesAreThereAndNothingWaitsForThem) {
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(step(std::nullopt));
  EXPECT_EQ(job().progress.waits_for, "its files are copied");
  EXPECT_FALSE(executor.started_with);
  release();
  EXPECT_FALSE(run->is_open());
  EXPECT_TRUE(testing::wait_until([&] { return step(std::nullopt) || run->is_open(); }));
  ASSERT_TRUE(executor.started_with);
  EXPECT_TRUE(std::filesystem::exists(executor.started_with->inputs / "model.obj"));
  EXPECT_EQ(jobs->executions()->front().handle, "h");
}

TEST_F(SlowShare, CancelIsStoredBeforeTheCopyEnds) {
  ASSERT_TRUE(jobs->cancel(id));
  run->stop(StopReason::kCancel);
  EXPECT_TRUE(step(std::nullopt));
  EXPECT_EQ(job().state, JobState::kCancelled);
  EXPECT_TRUE(executor.cancels.empty());
  release();
  const auto root = run->execution().folder;
  run.reset();
  EXPECT_FALSE(executor.started_with);
  EXPECT_FALSE(std::filesystem::exists(root));
}

TEST_F(SlowShare, MissingFileAndRefusedStartFailTheJob) {
  executor.refuses = true;
  release();
  EXPECT_TRUE(testing::wait_until([&] { return step(std::nullopt); }));
  EXPECT_EQ(job().failure->error.message, "refused");
  run.reset();
  std::filesystem::remove(layout.asset(kSha256));
  woken = {};
  begin();
  EXPECT_TRUE(testing::wait_until([&] { return step(std::nullopt); }));
  EXPECT_EQ(job().failure->error.reason, ErrorReason::ASSET_MISSING);
}

TEST_F(SlowShare, DaemonThatStopsKeepsTheJob) {
  EXPECT_TRUE(run->outlives_daemon());
  release();
  run.reset();
  EXPECT_EQ(jobs->executions()->size(), 1U);
  EXPECT_EQ(jobs->executions()->front().handle, "");
  EXPECT_FALSE(executor.started_with);
}

TEST_F(WorkerRunTest, CopyEndsAfterARequestToStop) {
  const auto file = folder.write("file", std::string(3 << 20, 'x'));
  std::stop_source stop;
  const UniqueFd source(::open(file.c_str(), O_RDONLY));
  EXPECT_TRUE(copy_bytes(source, 3 << 20, folder.path() / "copy", stop.get_token()));
  EXPECT_EQ(testing::content(folder.path() / "copy"), testing::content(file));
  stop.request_stop();
  EXPECT_EQ(copy_bytes(source, 3 << 20, folder.path() / "no", stop.get_token()).error().code,
            Code::kCancelled);
  EXPECT_FALSE(copy_bytes(source, 4 << 20, folder.path() / "short"));
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
