// Executions that outlive the daemon: found again, and never started twice.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <optional>
#include <random>
#include <set>
#include <sstream>

#include "daemon/workers/worker_pool.h"
#include "tests/daemon/workers/adoption/detached_executor.h"
#include "tests/daemon/workers/adoption/pool_store.h"
#include "tests/support/content.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace hydroprint::daemon {
namespace {

using hydroprint::testing::content;
using hydroprint::testing::wait_until;

// A worker that reports progress, waits for the file GO, and copies its spec to film.png. It also
// ends if its folder is deleted, so that it never outlives the test. With
// "stubborn" in the spec it ignores SIGTERM.
constexpr const char* kWorker = R"sh(#!/bin/sh
for argument; do
  case $argument in
    --out=*) out=${argument#--out=} ;;
    --spec=*) spec=${argument#--spec=} ;;
  esac
done
case $(cat "$spec") in *stubborn*) trap '' TERM ;; esac
echo '{"stage":"velocity","fraction":0.5,"total_fraction":0.5}' >&3
while [ ! -e GO ] && [ -e "$spec" ]; do sleep 0.1; done
mkdir "$out" && echo "{}" > "$out/report.json" && cp "$spec" "$out/film.png"
)sh";

class WorkerAdoption : public ::testing::Test {
 protected:
  WorkerAdoption() {
    std::string script = kWorker;
    std::filesystem::create_directories(store.layout.artifacts());
    script.replace(script.find("GO"), 2, go().string());
    worker = folder.write("worker", script);
    std::filesystem::permissions(worker, std::filesystem::perms::owner_all);
  }
  ~WorkerAdoption() override {
    daemon.reset();
    let_go();
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(store.layout.runs(), none)) {
      EXPECT_TRUE(wait_until([&] { return !lives(entry.path()); })) << entry.path();
    }
  }

  [[nodiscard]] std::filesystem::path go() const { return folder.path() / "go"; }
  void let_go() const { std::ofstream(go()).put('\n'); }
  [[nodiscard]] std::filesystem::path mute() const { return folder.path() / "mute"; }

  std::int64_t add(const std::string& spec = "{}") {
    NewJob definition;
    definition.owner = "ann";
    definition.work.verb = "simulate";
    definition.work.spec = spec;
    definition.use_cache = false;
    return store.jobs.create(definition, {}).value().id;
  }
  void start_daemon(int capacity = 4) {
    daemon.emplace(std::vector<std::string>{hydroprint::testing::program_path("detached_daemon"),
                                            folder.path().string(), worker.string(),
                                            std::to_string(capacity)});
  }
  void kill_daemon() {
    daemon->signal(SIGKILL);
    EXPECT_EQ(daemon->wait().signal, SIGKILL);
    daemon.reset();
  }
  [[nodiscard]] Job job(std::int64_t id) { return store.jobs.get(id).value(); }
  [[nodiscard]] bool computes(std::int64_t id) { return job(id).progress.phase == "velocity"; }
  [[nodiscard]] bool ends(std::int64_t id, JobState state) {
    return wait_until([&] { return is_finished(job(id).state); }, 30) && job(id).state == state;
  }
  [[nodiscard]] std::filesystem::path run_folder(std::int64_t id, std::int64_t attempt = 1) const {
    return store.layout.run(id, attempt).root;
  }
  /// Kills the worker and its runner, so that no exit file appears.
  void kill_worker(std::int64_t id) {
    ASSERT_EQ(store.jobs.executions()->size(), 1U);
    ASSERT_EQ(::kill(-std::stoi(store.jobs.executions()->front().handle), SIGKILL), 0);
    ASSERT_TRUE(wait_until([&] { return !lives(run_folder(id)); }));
  }
  /// The states of a job, without its progress.
  [[nodiscard]] std::vector<JobState> states(std::int64_t id) {
    std::vector<JobState> out;
    const auto events = store.jobs.events(id, 0, 1000).value();
    for (const JobEvent& event : events) {
      if (event.kind == EventKind::kStateChanged) out.push_back(event.state);
    }
    return out;
  }
  [[nodiscard]] bool has_event(std::int64_t id, const std::string& message) {
    const auto events = store.jobs.events(id, 0, 1000).value();
    return std::any_of(events.begin(), events.end(),
                       [&](const JobEvent& event) { return event.message == message; });
  }
  /// The started workers: "JOB ATTEMPT", one for each start.
  [[nodiscard]] std::multiset<std::string> starts() const { return lines_of("starts"); }
  [[nodiscard]] std::multiset<std::string> lines_of(const std::string& file) const {
    std::istringstream all(content(folder.path() / file));
    std::multiset<std::string> out;
    for (std::string line; std::getline(all, line);) out.insert(line);
    return out;
  }

  hydroprint::testing::TemporaryFolder folder;
  std::filesystem::path worker;
  PoolStore store{folder.path()};
  std::optional<hydroprint::testing::Process> daemon;
};

using States = std::vector<JobState>;
using Starts = std::multiset<std::string>;
const States kOneRun{JobState::kQueued, JobState::kRunning, JobState::kSucceeded};

TEST_F(WorkerAdoption, KilledDaemonFindsTwentyWorkersAgainAndStartsNoneTwice) {
  Starts expected;
  for (int i = 1; i <= 20; ++i) {
    add("{\"number\":" + std::to_string(i) + "}");
    expected.insert(std::to_string(i) + " 1");
  }
  start_daemon(20);
  for (int i = 1; i <= 20; ++i) ASSERT_TRUE(wait_until([&] { return computes(i); }, 60)) << i;
  kill_daemon();
  for (int i = 1; i <= 20; ++i) EXPECT_TRUE(lives(run_folder(i)));
  start_daemon(20);
  ASSERT_TRUE(wait_until([&] { return lines_of("offers").size() >= 20; }));
  let_go();
  for (int i = 1; i <= 20; ++i) {
    EXPECT_TRUE(ends(i, JobState::kSucceeded));
    EXPECT_EQ(states(i), kOneRun);
    EXPECT_EQ(job(i).attempts, 1);
    EXPECT_EQ(content(store.layout.artifacts(i) / "film.png"),
              "{\"number\":" + std::to_string(i) + "}");
  }
  EXPECT_EQ(starts(), expected);
  EXPECT_TRUE(store.jobs.executions()->empty());
  EXPECT_TRUE(wait_until([&] { return std::filesystem::is_empty(store.layout.runs()); }));
}

TEST_F(WorkerAdoption, CleanStopLeavesTheWorkerRunning) {
  const std::int64_t id = add();
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return computes(id); }));
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait().status, 0);
  EXPECT_EQ(job(id).state, JobState::kRunning);
  EXPECT_EQ(store.jobs.executions()->size(), 1U);
  EXPECT_TRUE(lives(run_folder(id)));
  start_daemon();
  let_go();
  EXPECT_TRUE(ends(id, JobState::kSucceeded));
  EXPECT_EQ(states(id), kOneRun);
  EXPECT_EQ(starts(), Starts{"1 1"});
}

TEST_F(WorkerAdoption, AdoptedWorkersAreCancelledGentlyAndThenAtOnce) {
  const std::int64_t gentle = add(), stubborn = add("{\"is\":\"stubborn\"}");
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return computes(gentle) && computes(stubborn); }));
  kill_daemon();
  ASSERT_TRUE(store.jobs.cancel(gentle)) << "while no daemon runs";
  start_daemon();
  EXPECT_TRUE(ends(gentle, JobState::kCancelled));
  EXPECT_EQ(job(stubborn).state, JobState::kRunning);
  ASSERT_TRUE(store.jobs.cancel(stubborn));
  EXPECT_TRUE(ends(stubborn, JobState::kCancelled));
  EXPECT_FALSE(lives(run_folder(gentle)) || lives(run_folder(stubborn)));
  EXPECT_EQ(starts(), (Starts{"1 1", "2 1"}));
}

TEST_F(WorkerAdoption, ResultOfAWorkerThatEndedWithoutADaemonIsCollected) {
  const std::int64_t good = add(), bad = add("{\"is\":\"killed\"}");
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return computes(good) && computes(bad); }));
  kill_daemon();
  ASSERT_EQ(::kill(std::stoi(content(run_folder(bad) / "begin")), SIGKILL), 0);
  let_go();
  for (const std::int64_t id : {good, bad}) {
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(run_folder(id) / "exit"); }));
  }
  start_daemon();
  EXPECT_TRUE(ends(good, JobState::kSucceeded));
  EXPECT_TRUE(ends(bad, JobState::kFailed));
  EXPECT_EQ(job(bad).failure->error.reason, ErrorReason::WORKER_KILLED);
  EXPECT_EQ(job(bad).failure->signal, SIGKILL);
  EXPECT_EQ(starts(), (Starts{"1 1", "2 1"}));
}

TEST_F(WorkerAdoption, GoneWorkerIsQueuedAgainAsAfterALossOfTheDaemon) {
  const std::int64_t id = add();
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return computes(id); }));
  kill_daemon();
  kill_worker(id);
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return job(id).attempts == 2 && computes(id); }));
  EXPECT_FALSE(std::filesystem::exists(run_folder(id)));
  EXPECT_TRUE(has_event(id, "the daemon was restarted"));
  let_go();
  EXPECT_TRUE(ends(id, JobState::kSucceeded));
  EXPECT_EQ(states(id), (States{JobState::kQueued, JobState::kRunning, JobState::kInterrupted,
                                JobState::kQueued, JobState::kRunning, JobState::kSucceeded}));
  EXPECT_EQ(starts(), (Starts{"1 1", "1 2"}));
}

TEST_F(WorkerAdoption, WorkerThatIsLostWhileTheDaemonRunsIsQueuedAgain) {
  const std::int64_t id = add();
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return computes(id); }));
  kill_worker(id);
  ASSERT_TRUE(wait_until([&] { return job(id).attempts == 2; }));
  EXPECT_TRUE(has_event(id, "the worker was lost"));
  let_go();
  EXPECT_TRUE(ends(id, JobState::kSucceeded));
  EXPECT_EQ(starts(), (Starts{"1 1", "1 2"}));
}

TEST_F(WorkerAdoption, SilentExecutorIsAskedAgainEachSecond) {
  const std::int64_t id = add();
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return computes(id); }));
  kill_daemon();
  std::ofstream(mute()).put('\n');
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return lines_of("offers").size() >= 3; }));
  EXPECT_EQ(job(id).state, JobState::kRunning);
  EXPECT_TRUE(lives(run_folder(id)));
  std::filesystem::remove(mute());
  let_go();
  EXPECT_TRUE(ends(id, JobState::kSucceeded));
  EXPECT_EQ(states(id), kOneRun);
  EXPECT_EQ(starts(), Starts{"1 1"});
}

TEST_F(WorkerAdoption, DaemonKilledBeforeItKnewTheHandleFindsTheWorker) {
  const std::int64_t id = add();
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return computes(id); }));
  kill_daemon();
  ASSERT_TRUE(store.database->run("UPDATE executions SET handle=''"));
  start_daemon();
  let_go();
  EXPECT_TRUE(ends(id, JobState::kSucceeded));
  EXPECT_EQ(starts(), Starts{"1 1"});
}

TEST_F(WorkerAdoption, DaemonKilledBeforeItStartedTheWorkerStartsTheNextAttempt) {
  const std::int64_t id = add();
  let_go();
  ASSERT_TRUE(store.jobs.start(id, "detached"));
  start_daemon();
  EXPECT_TRUE(ends(id, JobState::kSucceeded));
  EXPECT_EQ(starts(), Starts{"1 2"});
}

TEST_F(WorkerAdoption, DaemonKilledWhilePublishingPublishesAgain) {
  const std::int64_t id = add();
  start_daemon();
  ASSERT_TRUE(wait_until([&] { return computes(id); }));
  kill_daemon();
  let_go();
  ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(run_folder(id) / "exit"); }));
  std::filesystem::rename(store.layout.run(id).out(), store.layout.artifacts(id));
  start_daemon();
  EXPECT_TRUE(ends(id, JobState::kSucceeded));
  EXPECT_EQ(content(store.layout.artifacts(id) / "film.png"), "{}");
  EXPECT_EQ(store.jobs.artifacts(id, "", 10)->size(), 2U);  // with report.json
  EXPECT_FALSE(std::filesystem::exists(store.layout.set_aside()));
}

TEST_F(WorkerAdoption, RandomKillsStartEachWorkerExactlyOnce) {
  constexpr int kJobs = 12;
  for (int i = 0; i < kJobs; ++i) add();
  std::mt19937 random(37);
  std::uniform_int_distribution<int> delay_ms(0, 60);
  for (int kill = 0; kill < 25; ++kill) {
    if (kill == 20) let_go();
    start_daemon(3);
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms(random)));
    kill_daemon();
  }
  start_daemon(3);
  let_go();
  std::multiset<std::string> started;
  EXPECT_TRUE(wait_until([&] { return is_finished(job(kJobs).state); }, 30));
  for (const std::string& line : starts()) started.insert(line.substr(0, line.find(' ')));
  int given_up = 0;  // lost three times before its worker started, on a machine that is slow enough
  for (int i = 1; i <= kJobs; ++i) {
    const bool succeeds = ends(i, JobState::kSucceeded);
    if (!succeeds) {
      ++given_up;
      ASSERT_TRUE(job(i).failure) << i;
      EXPECT_EQ(job(i).failure->error.reason, ErrorReason::DAEMON_LOST)
          << job(i).failure->error.message;
    }
    EXPECT_EQ(started.count(std::to_string(i)), succeeds ? 1U : 0U) << i;
  }
  EXPECT_LE(given_up, 1);
}

// In this process, since the limit on silence is an hour.
class SilentWorkerExecutor : public WorkerAdoption {
 protected:
  void make_pool() {
    PoolOptions options;
    options.program = worker;
    pool = WorkerPool::make(options, executor, store.jobs, store.queue, store.layout,
                            system_clock_ms, std::chrono::milliseconds(1500))
               .value();
    pool->start();
  }
  ~SilentWorkerExecutor() override { pool.reset(); }

  DetachedExecutor executor{folder.path(), 4};
  std::unique_ptr<WorkerPool> pool;
};

TEST_F(SilentWorkerExecutor, FailsTheJobAtTheLimitAndNeverStartsItAgain) {
  const std::int64_t id = add();
  make_pool();
  ASSERT_TRUE(wait_until([&] { return computes(id); }));
  pool.reset();
  std::ofstream(mute()).put('\n');
  make_pool();
  EXPECT_TRUE(ends(id, JobState::kFailed));
  EXPECT_EQ(job(id).failure->error.reason, ErrorReason::WORKER_UNUSABLE);
  EXPECT_NE(job(id).failure->error.message.find("did not answer"), std::string::npos);
  EXPECT_GE(lines_of("offers").size(), 2U);
  EXPECT_EQ(starts(), Starts{"1 1"});
  EXPECT_TRUE(store.jobs.executions()->empty());
}

TEST_F(SilentWorkerExecutor, ExecutionOfAnotherExecutorIsNeitherGoneNorStartedAgain) {
  const std::int64_t id = add();
  ASSERT_TRUE(store.jobs.start(id, "elsewhere"));
  EXPECT_EQ(surviving(executor, store.jobs)->size(), 1U);
  make_pool();
  EXPECT_TRUE(ends(id, JobState::kFailed));
  EXPECT_NE(job(id).failure->error.message.find("\"elsewhere\""), std::string::npos);
  EXPECT_EQ(starts(), Starts{});
}

TEST_F(SilentWorkerExecutor, LocalExecutionOfAnEarlierDaemonIsGone) {
  const std::int64_t id = add();
  ASSERT_TRUE(store.jobs.start(id, "local"));
  EXPECT_TRUE(surviving(executor, store.jobs)->empty());
  let_go();
  make_pool();
  EXPECT_TRUE(ends(id, JobState::kSucceeded));
  EXPECT_EQ(starts(), Starts{"1 2"});
}

}  // namespace
}  // namespace hydroprint::daemon
