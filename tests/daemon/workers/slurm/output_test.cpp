// Output of workers that were taken over, on a node: a shell command in the worker's place, run by
// the script of the execution. A script takes the place of sbatch and starts it.
#include <gtest/gtest.h>

#include "daemon/workers/slurm/slurm_executor.h"
#include "daemon/workers/worker_run.h"
#include "tests/daemon/store/store_fixture.h"
#include "tests/daemon/workers/slurm/scripted_engine.h"
#include "tests/support/content.h"
#include "tests/support/timing.h"

namespace hydroprint::daemon::slurm {
namespace {

class SlurmOutput : public StoreTest {
 protected:
  SlurmOutput() {
    std::filesystem::create_directories(others / "out");
    std::ofstream(others / "key.pem") << "secret";
    std::ofstream(others / "out" / "film.png") << "another person's film";
    std::filesystem::create_directory(folder.path() / "shared");
    engine.does("sbatch", "setsid sh \"$2\" </dev/null >/dev/null 2>&1 & echo 1");
    executor = SlurmExecutor::make({.folder = folder.path() / "shared"}, {}).value();
  }

  // Starts a job whose worker is a shell command, which runs in the worker's folder.
  void start(const std::string& command) {
    const auto worker = folder.path() / "worker";
    std::ofstream(worker) << "#!/bin/sh\n[ \"$1\" = --version ] && exec echo '{\"build_id\": "
                             "\"ab12\"}'\ncd ../work\n"
                          << command << "\n";
    std::filesystem::permissions(worker, std::filesystem::perms::owner_all);
    id = add("digest of " + command).id;
    const Job job = jobs->start(id, executor->name(), executor->runs(layout)).value();
    const Execution execution = jobs->executions()->front();
    const RunFolder files{execution.folder};
    ASSERT_TRUE(make_folder(files.work()));
    const Launch launch{.program = worker,
                        .inputs = files.inputs(),
                        .work = files.work(),
                        .build_id = "ab12",
                        .confined = false};
    run = WorkerRun::start(job, execution, launch,
                           {*executor, layout, {std::chrono::seconds(600)}, [] {}})
              .value();
  }
  bool step() {
    const Execution& execution = run->execution();
    const auto seen =
        run->is_open() ? of_job(executor->poll({execution}), execution.job) : std::nullopt;
    return run->step(seen, *jobs, now_ms);
  }
  [[nodiscard]] Job end_of(const std::string& command) {
    start(command);
    EXPECT_TRUE(testing::wait_until([&] { return step(); }, 60));
    run.reset();
    return jobs->get(id).value();
  }
  void expect_failed(const std::string& command, ErrorReason reason) {
    const Job job = end_of(command);
    EXPECT_EQ(job.state, JobState::kFailed) << command;
    ASSERT_TRUE(job.failure) << command;
    EXPECT_EQ(job.failure->error.reason, reason) << command << ": " << job.failure->error.message;
    EXPECT_FALSE(std::filesystem::exists(layout.artifacts(id)));
    EXPECT_TRUE(std::filesystem::is_empty(layout.runs())) << "no copy is left";
    EXPECT_EQ(testing::content(others / "key.pem"), "secret");
  }

  const std::filesystem::path others = folder.path() / "others";
  ScriptedEngine engine{folder.path() / "bin"};
  std::unique_ptr<SlurmExecutor> executor;
  std::int64_t id = 0;
  std::unique_ptr<WorkerRun> run;
};

TEST_F(SlurmOutput, PlainFilesAreCopiedAndPublished) {
  const Job job = end_of("mkdir out; printf film >out/film.png; echo '{}' >out/report.json");
  ASSERT_EQ(job.state, JobState::kSucceeded) << job.failure->error.message;
  EXPECT_EQ(testing::content(layout.artifacts(id) / "film.png"), "film");
  EXPECT_EQ(jobs->artifacts(id, "", 10)->front().sha256, sha256("film"));
  EXPECT_TRUE(std::filesystem::is_empty(layout.runs()));
}

TEST_F(SlurmOutput, LinksAreNotFollowed) {
  expect_failed("ln -s '" + others.string() + "' out", ErrorReason::WORKER_UNUSABLE);
  expect_failed("ln -s out out", ErrorReason::WORKER_UNUSABLE);
  expect_failed("mkdir out; ln -s '" + others.string() + "/key.pem' out/film.png",
                ErrorReason::WORKER_UNUSABLE);
  expect_failed("mkdir out; ln '" + others.string() + "/key.pem' out/film.png",
                ErrorReason::WORKER_UNUSABLE);
  // Only a worker that is not confined can exchange this one.
  expect_failed("cd ..; mv work aside; ln -s '" + others.string() + "' work",
                ErrorReason::WORKER_UNUSABLE);
}

TEST_F(SlurmOutput, OtherThingsThanFilesAreRefused) {
  expect_failed("mkdir out; mkfifo out/film.png", ErrorReason::WORKER_UNUSABLE);
  expect_failed("mkdir -p out/a/b/c/d/e/f; touch out/a/b/film.png", ErrorReason::WORKER_UNUSABLE);
  expect_failed("true", ErrorReason::WORKER_UNUSABLE);
}

TEST_F(SlurmOutput, SparseFilesAreRefusedBeforeTheyAreCopied) {
  expect_failed("mkdir out; cd out; for i in $(seq 400); do truncate -s 4G $i; done",
                ErrorReason::OUTPUT_LIMIT);
}

TEST_F(SlurmOutput, CancelEndsTheCopy) {
  start("mkdir out; truncate -s 3G out/film.png");
  const auto copy = layout.runs() / (run->execution().folder.filename().string() + ".output");
  ASSERT_TRUE(testing::wait_until(
      [&] { return step() || std::filesystem::exists(copy / "film.png"); }, 60));
  ASSERT_TRUE(jobs->cancel(id));
  run->stop(StopReason::kCancel);
  EXPECT_TRUE(testing::wait_until([&] { return step(); }, 60));
  EXPECT_EQ(jobs->get(id)->state, JobState::kCancelled);
  EXPECT_FALSE(std::filesystem::exists(copy));
}

}  // namespace
}  // namespace hydroprint::daemon::slurm
