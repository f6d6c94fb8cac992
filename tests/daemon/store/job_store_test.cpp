#include <fstream>

#include "tests/daemon/store/store_fixture.h"

namespace hydroprint::daemon {
namespace {

using States = std::vector<JobState>;

class JobStoreTest : public StoreTest {};

TEST_F(JobStoreTest, IdsAreNeverReused) {
  const std::int64_t first = complete(add().id).id;
  EXPECT_TRUE(jobs->remove(first));
  open();
  EXPECT_GT(add().id, first);
}

TEST_F(JobStoreTest, RepeatedRequestReturnsTheSameJob) {
  NewJob definition;
  definition.owner = "ann";
  definition.work.verb = "simulate";
  const RequestKey key{"CreateJob", "id-1", "content"};
  const Job job = jobs->create(definition, key).value();
  open();
  EXPECT_EQ(jobs->create(definition, key)->id, job.id);
  const auto other = jobs->create(definition, {"CreateJob", "id-1", "other content"});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().reason, ErrorReason::REQUEST_ID_REUSED);
  definition.owner = "bob";
  EXPECT_NE(jobs->create(definition, key)->id, job.id)
      << "another owner may use the same request id";
}

TEST_F(JobStoreTest, RequestIsForgottenAfterSevenDays) {
  NewJob definition;
  definition.work.verb = "simulate";
  const RequestKey key{"CreateJob", "id-1", "content"};
  const Job job = jobs->create(definition, key).value();
  now_ms += 7LL * 24 * 3600 * 1000 - 1;
  EXPECT_EQ(jobs->create(definition, key)->id, job.id);
  now_ms += 2;
  EXPECT_NE(jobs->create(definition, key)->id, job.id);
}

TEST_F(JobStoreTest, FullQueueRefusesWithoutSideEffects) {
  for (int i = 0; i < 5; ++i) add();
  NewJob definition;
  definition.work.verb = "simulate";
  const auto sixth = jobs->create(definition, {"CreateJob", "id", "x"});
  ASSERT_FALSE(sixth);
  EXPECT_EQ(sixth.error().reason, ErrorReason::QUEUE_FULL);
  EXPECT_EQ(jobs->list({})->size(), 5U);
  ASSERT_TRUE(jobs->cancel(1));
  EXPECT_TRUE(jobs->create(definition, {"CreateJob", "id", "other"}))
      << "the refused request did not use up its id";
}

TEST_F(JobStoreTest, MissingInputIsNamed) {
  NewJob definition;
  definition.work.verb = "simulate";
  definition.work.inputs = {{"spot.obj", std::string(64, 'a')}};
  const auto job = jobs->create(definition, {});
  ASSERT_FALSE(job);
  EXPECT_EQ(job.error().reason, ErrorReason::ASSET_MISSING);
  EXPECT_EQ(job.error().metadata.at("asset"), "assets/" + std::string(64, 'a'));
  EXPECT_TRUE(jobs->list({})->empty());
}

TEST_F(JobStoreTest, LostDaemonIsRecordedAndTheJobIsQueuedAgain) {
  const std::int64_t id = add().id;
  ASSERT_TRUE(jobs->start(id));
  open();
  EXPECT_EQ(jobs->get(id)->state, JobState::kQueued);
  EXPECT_EQ(states(id), (States{JobState::kQueued, JobState::kRunning, JobState::kInterrupted,
                                JobState::kQueued}));
}

TEST_F(JobStoreTest, ExecutionIsOpenUntilTheJobEndsOrIsQueuedAgain) {
  const std::int64_t id = add().id;
  EXPECT_EQ(jobs->start(id, "engine")->attempts, 1);
  Execution open_one = jobs->executions()->front();
  EXPECT_EQ(open_one.job, id);
  EXPECT_EQ(open_one.attempt, 1);
  EXPECT_EQ(open_one.executor, "engine");
  EXPECT_EQ(open_one.handle, "");
  EXPECT_EQ(open_one.folder, layout.run(id, 1).root);
  open_one.handle = "h-17";
  ASSERT_TRUE(jobs->note_handle(open_one));
  EXPECT_EQ(jobs->executions()->front().handle, "h-17");
  EXPECT_EQ(jobs->interrupt(id, Interruption::kWorkerLoss)->state, JobState::kQueued);
  EXPECT_TRUE(jobs->executions()->empty());
  EXPECT_EQ(jobs->start(id, "engine")->attempts, 2);
  EXPECT_EQ(jobs->executions()->front().folder, layout.run(id, 2).root);
  ASSERT_TRUE(jobs->note_handle(open_one)) << "of the earlier attempt";
  EXPECT_EQ(jobs->executions()->front().handle, "");
  ASSERT_TRUE(jobs->cancel(id));
  EXPECT_EQ(jobs->executions()->size(), 1U) << "the worker has not ended yet";
  ASSERT_TRUE(jobs->give_up(id, {}));
  EXPECT_TRUE(jobs->executions()->empty());
}

TEST_F(JobStoreTest, KeptExecutionsAreNeitherInterruptedNorSweptAway) {
  const std::int64_t kept = add("1").id, lost = add("2").id;
  for (const std::int64_t id : {kept, lost}) {
    ASSERT_TRUE(jobs->start(id, "engine"));
    std::filesystem::create_directories(layout.run(id).work());
    std::filesystem::create_directories(layout.artifacts(id));
    std::ofstream(layout.artifacts(id) / "film.png") << id;
  }
  const std::vector<Execution> going_on{jobs->executions()->front()};
  ASSERT_TRUE(job_retention->sweep(going_on));
  ASSERT_TRUE(jobs->interrupt_all(Interruption::kLoss, going_on));
  EXPECT_EQ(jobs->get(kept)->state, JobState::kRunning);
  EXPECT_EQ(jobs->get(lost)->state, JobState::kQueued);
  EXPECT_TRUE(std::filesystem::exists(layout.run(kept).work()));
  EXPECT_FALSE(std::filesystem::exists(layout.run(lost).root));
  EXPECT_TRUE(std::filesystem::exists(layout.artifacts(kept) / "film.png"));
  EXPECT_EQ(set_aside(), std::multiset<std::string>{std::to_string(lost)});
  ASSERT_EQ(jobs->executions()->size(), 1U);
  EXPECT_EQ(jobs->executions()->front().job, kept);
}

TEST_F(JobStoreTest, ThirdLossOfItsWorkerFailsTheJob) {
  const std::int64_t id = add().id;
  for (int loss = 1; loss <= 3; ++loss) {
    ASSERT_TRUE(jobs->start(id, "engine"));
    ASSERT_TRUE(jobs->interrupt(id, Interruption::kWorkerLoss));
  }
  EXPECT_EQ(jobs->get(id)->state, JobState::kFailed);
  EXPECT_EQ(jobs->get(id)->failure->error.reason, ErrorReason::WORKER_KILLED);
  EXPECT_TRUE(jobs->executions()->empty());
  EXPECT_EQ(jobs->interrupt(id, Interruption::kWorkerLoss).error().reason,
            ErrorReason::STATE_FORBIDS);
}

TEST_F(JobStoreTest, ThirdLossFailsTheJobAndARetryStartsOver) {
  const std::int64_t id = add().id;
  for (int loss = 1; loss <= 3; ++loss) {
    EXPECT_EQ(jobs->get(id)->state, JobState::kQueued) << loss;
    ASSERT_TRUE(jobs->start(id));
    open();
  }
  const Job lost = jobs->get(id).value();
  EXPECT_EQ(lost.state, JobState::kFailed);
  EXPECT_EQ(lost.failure->error.reason, ErrorReason::DAEMON_LOST);
  EXPECT_EQ(lost.failure->error.code, Code::kInternal);
  const Job retried = add();
  ASSERT_TRUE(jobs->start(retried.id));
  open();
  EXPECT_EQ(jobs->get(retried.id)->state, JobState::kQueued);
}

TEST_F(JobStoreTest, OnlyLossesWhileRunningCount) {
  const std::int64_t id = add().id;
  for (int i = 0; i < 4; ++i) {
    open();
    ASSERT_TRUE(jobs->start(id));
    ASSERT_TRUE(jobs->interrupt_all(Interruption::kShutdown));
  }
  EXPECT_EQ(jobs->get(id)->state, JobState::kQueued);
}

// SQLite's limit on the size of the database stands for a full disk.
TEST_F(JobStoreTest, FullDatabaseRefusesWithoutSideEffectsAndRecovers) {
  job_options.max_queued = 1000000;
  open();
  const std::int64_t first = complete(add("same").id).id;
  // SQLite uses the present number of pages as the limit.
  ASSERT_TRUE(database->run("PRAGMA max_page_count=1"));
  NewJob definition;
  definition.owner = "ann";
  definition.work.verb = "simulate";
  definition.digest = "same";
  definition.body = std::string(1000000, 'x');  // more than the reserved space
  const auto refused = jobs->create(definition, {"CreateJob", "id", "x"});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::kResourceExhausted);
  EXPECT_EQ(refused.error().reason, ErrorReason::DISK_FULL);
  EXPECT_EQ(jobs->list({})->size(), 1U);
  EXPECT_EQ(jobs->get(first)->state, JobState::kSucceeded);
  ASSERT_TRUE(database->run("PRAGMA max_page_count=1000000"));
  EXPECT_TRUE(jobs->create(definition, {"CreateJob", "id", "x"})->cache_hit);
}

TEST_F(JobStoreTest, CancelSurvivesALostDaemon) {
  const std::int64_t id = add().id;
  ASSERT_TRUE(jobs->start(id));
  EXPECT_EQ(jobs->cancel(id)->state, JobState::kCancelling);
  open();
  EXPECT_EQ(jobs->get(id)->state, JobState::kCancelled);
}

TEST_F(JobStoreTest, CancelledJobStaysCancelledEvenIfItsWorkerSucceeds) {
  const std::int64_t id = add().id;
  ASSERT_TRUE(jobs->start(id));
  ASSERT_TRUE(jobs->cancel(id));
  EXPECT_EQ(jobs->succeed(id, {})->state, JobState::kCancelled);
  EXPECT_EQ(jobs->cancel(id)->state, JobState::kCancelled) << "a second cancel is not an error";
}

TEST_F(JobStoreTest, FinishedJobsCannotBeCancelledAndOpenOnesNotDeleted) {
  const std::int64_t id = add().id;
  EXPECT_EQ(jobs->remove(id).error().reason, ErrorReason::STATE_FORBIDS);
  complete(id);
  EXPECT_EQ(jobs->cancel(id).error().reason, ErrorReason::STATE_FORBIDS);
  EXPECT_EQ(jobs->cancel(id).error().metadata.at("state"), "SUCCEEDED");
  EXPECT_TRUE(jobs->remove(id));
  EXPECT_EQ(jobs->get(id).error().reason, ErrorReason::JOB_NOT_FOUND);
  EXPECT_FALSE(std::filesystem::exists(layout.artifacts(id)));
}

TEST_F(JobStoreTest, SameInputsGetTheEarlierArtifacts) {
  complete(add("same").id, "film");
  const Job hit = add("same");
  EXPECT_EQ(hit.state, JobState::kSucceeded);
  EXPECT_TRUE(hit.cache_hit);
  EXPECT_EQ(jobs->artifact(hit.id, "film.png")->sha256, sha256("film"));
  EXPECT_TRUE(jobs->remove(1)) << "the job whose artifacts were reused can be deleted";
  EXPECT_EQ(sha256_of_file(layout.artifacts(hit.id) / "film.png").value(), sha256("film"));
  EXPECT_EQ(add("other").state, JobState::kQueued);
}

TEST_F(JobStoreTest, EqualJobThatFinishesFirstSavesTheSecondRun) {
  const Job first = add("same"), second = add("same");
  complete(first.id);
  const Job started = jobs->start(second.id).value();
  EXPECT_EQ(started.state, JobState::kSucceeded);
  EXPECT_TRUE(started.cache_hit);
}

TEST_F(JobStoreTest, DamagedCacheIsNotServed) {
  complete(add("same").id);
  std::filesystem::remove(layout.artifacts(1) / "film.png");
  EXPECT_EQ(add("same").state, JobState::kQueued);
}

TEST_F(JobStoreTest, ProgressIsKeptOnlyWhileRunning) {
  const std::int64_t id = add().id;
  ASSERT_TRUE(jobs->report(id, {0.5, "velocity", 0.1, 0}));
  EXPECT_EQ(jobs->get(id)->progress.fraction, 0);
  ASSERT_TRUE(jobs->start(id));
  ASSERT_TRUE(jobs->report(id, {0.5, "velocity", 0.1, 7}));
  EXPECT_EQ(jobs->get(id)->progress.phase, "velocity");
  EXPECT_EQ(jobs->events(id, 0, 10)->back().kind, EventKind::kProgress);
  ASSERT_TRUE(jobs->give_up(
      id, {{Code::kInternal, "it broke", ErrorReason::COMPUTATION_FAILED, {}}, 4, {}}));
  EXPECT_EQ(states(id), (States{JobState::kQueued, JobState::kRunning, JobState::kFailed}));
  EXPECT_EQ(jobs->get(id)->failure->error.message, "it broke");
  EXPECT_EQ(jobs->get(id)->failure->exit_status, 4);
}

TEST_F(JobStoreTest, EventNumbersNeverRepeatAndUnknownOnesAreRefused) {
  const std::int64_t id = add().id;
  ASSERT_TRUE(jobs->start(id));
  ASSERT_TRUE(jobs->report(id, {0.5, "x", 0, 0}));
  complete(add("2").id);
  const std::int64_t last = jobs->last_seq().value();
  EXPECT_EQ(jobs->events(id, last + 1, 10).error().reason, ErrorReason::EVENTS_GONE);
  EXPECT_EQ(jobs->events(id, -1, 10).error().reason, ErrorReason::EVENTS_GONE);
  EXPECT_TRUE(jobs->events(id, last, 10)->empty());
  open();
  EXPECT_GT(jobs->last_seq().value(), last);
}

TEST_F(JobStoreTest, MovedJobTakesOverRankAndPriority) {
  for (int i = 0; i < 3; ++i) add();
  const std::int64_t urgent = add("u", "ann", 5).id;
  const auto order = [&] {
    std::vector<std::int64_t> ids;
    const auto waiting = queue->waiting().value();
    for (const WaitingJob& job : waiting) ids.push_back(job.id);
    return ids;
  };
  EXPECT_EQ(order(), (std::vector<std::int64_t>{urgent, 1, 2, 3}));
  EXPECT_EQ(queue->move(3, urgent)->definition.priority, 5);
  EXPECT_EQ(order(), (std::vector<std::int64_t>{3, urgent, 1, 2}));
  ASSERT_TRUE(queue->move(3, 2));
  EXPECT_EQ(order(), (std::vector<std::int64_t>{urgent, 1, 3, 2}));
  ASSERT_TRUE(queue->move(urgent, 0));
  EXPECT_EQ(order(), (std::vector<std::int64_t>{1, 3, 2, urgent}));
  ASSERT_TRUE(queue->move(1, 1));
  EXPECT_EQ(order().front(), 1);
}

TEST_F(JobStoreTest, OnlyQueuedJobsOfOneOwnerMove) {
  add();
  add("2", "bob");
  complete(add("3").id);
  EXPECT_EQ(queue->move(1, 2).error().reason, ErrorReason::STATE_FORBIDS);
  EXPECT_EQ(queue->move(1, 3).error().reason, ErrorReason::STATE_FORBIDS);
  EXPECT_EQ(queue->move(3, 1).error().reason, ErrorReason::STATE_FORBIDS);
  EXPECT_EQ(queue->move(1, 99).error().reason, ErrorReason::JOB_NOT_FOUND);
}

TEST_F(JobStoreTest, PauseSurvivesARestart) {
  EXPECT_FALSE(queue->pause()->paused);
  ASSERT_TRUE(queue->set_pause({true, "lunch"}));
  open();
  EXPECT_TRUE(queue->pause()->paused);
  EXPECT_EQ(queue->pause()->reason, "lunch");
  ASSERT_TRUE(queue->set_pause({}));
  EXPECT_FALSE(queue->pause()->paused);
}

TEST_F(JobStoreTest, ListFiltersAndPages) {
  for (const char* owner : {"ann", "bob", "ann", "bob"}) add(owner, owner);
  ASSERT_TRUE(jobs->cancel(3));
  JobFilter filter;
  filter.owner = "ann";
  EXPECT_EQ(jobs->list(filter)->size(), 2U);
  filter.states = {JobState::kCancelled};
  EXPECT_EQ(jobs->list(filter)->front().id, 3);
  EXPECT_EQ(jobs->list({{}, "", 3, 1})->front().id, 2);
}

TEST_F(JobStoreTest, OnlyOldFinishedJobsArePurged) {
  complete(add("1").id);
  add("2");
  now_ms += 999;
  ASSERT_TRUE(job_retention->purge());
  EXPECT_TRUE(jobs->get(1));
  now_ms += 1;
  ASSERT_TRUE(job_retention->purge());
  EXPECT_FALSE(jobs->get(1));
  EXPECT_TRUE(jobs->get(2));
}

TEST_F(JobStoreTest, UnknownFoldersAreSetAsideAtTheStart) {
  complete(add("1").id);
  ASSERT_TRUE(jobs->start(add("2").id));
  std::filesystem::create_directories(layout.artifacts(2));  // as if killed after the rename
  std::ofstream(layout.artifacts(2) / "film.png") << "not committed";
  std::filesystem::create_directories(layout.run(2).inputs());
  std::filesystem::create_directories(layout.artifacts() / "junk");
  open();
  EXPECT_TRUE(std::filesystem::exists(layout.artifacts(1) / "film.png"));
  EXPECT_FALSE(std::filesystem::exists(layout.artifacts(2)));
  EXPECT_FALSE(std::filesystem::exists(layout.artifacts() / "junk"));
  EXPECT_EQ(set_aside(), (std::multiset<std::string>{"not committed"}));
  EXPECT_TRUE(std::filesystem::is_empty(layout.runs()));
}

TEST_F(JobStoreTest, InvalidDatabaseFileIsRefused) {
  const auto path = folder.path() / "junk.db";
  std::ofstream(path) << std::string(5000, 'x');
  const auto opened = Database::open(path, "");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().reason, ErrorReason::STORE_FAILED);
  EXPECT_NE(opened.error().message.find("junk.db"), std::string::npos);
}

TEST_F(JobStoreTest, FailedTransactionIsRolledBack) {
  const Status status = database->transaction([&]() -> Status {
    EXPECT_TRUE(database->run("INSERT INTO settings VALUES ('a','b')"));
    return fail(Code::kInternal, "no");
  });
  EXPECT_FALSE(status);
  int rows = 0;
  ASSERT_TRUE(
      database->each("SELECT 1 FROM settings WHERE name='a'", {}, [&](const DbRow&) { ++rows; }));
  EXPECT_EQ(rows, 0);
}

NewJob new_dip() {
  NewJob definition;
  definition.owner = "ann";
  definition.work.verb = "dip";
  definition.traits.computed = false;
  definition.use_cache = false;
  definition.dip_status = "first";
  return definition;
}

TEST_F(JobStoreTest, DipsAreNotQueuedAndRunOneAtATime) {
  const Job dip = jobs->create(new_dip(), {}).value();
  EXPECT_EQ(dip.state, JobState::kWaitingForOperator);
  EXPECT_EQ(dip.dip_status, "first");
  EXPECT_TRUE(queue->waiting()->empty());
  const auto second = jobs->create(new_dip(), {});
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().reason, ErrorReason::STATE_FORBIDS);
  for (int i = 0; i < 5; ++i) add(std::to_string(i));  // a full queue must not affect dips
  ASSERT_TRUE(device_jobs->end(dip.id, JobState::kCancelled, {}, "", {}, ""));
  EXPECT_TRUE(jobs->create(new_dip(), {}));
}

NewJob new_print() {
  NewJob definition;
  definition.owner = "ann";
  definition.work.verb = "print";
  definition.traits = {false, true, "the printer may have printed this or not"};
  return definition;
}

TEST_F(JobStoreTest, PrintsAreNotQueuedOrCachedAndRunOneAtATime) {
  const Job print = jobs->create(new_print(), {}).value();
  EXPECT_EQ(print.state, JobState::kRunning);
  EXPECT_TRUE(queue->waiting()->empty());
  EXPECT_EQ(jobs->create(new_print(), {}).error().reason, ErrorReason::STATE_FORBIDS);
  EXPECT_TRUE(jobs->create(new_dip(), {})) << "a dip uses the rig, not the printer";
  ASSERT_TRUE(device_jobs->end(print.id, JobState::kSucceeded, {}, "", {}, ""));
  EXPECT_EQ(jobs->create(new_print(), {})->state, JobState::kRunning);
}

TEST_F(JobStoreTest, LostPrintStaysInterruptedWithAdvice) {
  const Job print = jobs->create(new_print(), {}).value();
  ASSERT_TRUE(
      device_jobs->advance(print.id, JobState::kRunning, "", {0.3, "PROCESSING", 0, 0}, "prints"));
  EXPECT_GT(jobs->get(print.id)->start_ms, 0);
  open();
  EXPECT_EQ(jobs->get(print.id)->state, JobState::kInterrupted);
  const auto events = jobs->events(print.id, 0, 100).value();
  EXPECT_NE(events.back().message.find("may have printed this or not"), std::string::npos);
}

TEST_F(JobStoreTest, LostDipStaysInterrupted) {
  const Job dip = jobs->create(new_dip(), {}).value();
  ASSERT_TRUE(
      device_jobs->advance(dip.id, JobState::kRunning, "soak", {0.5, "SOAK", 0, 0}, "soaks"));
  open();
  const Job lost = jobs->get(dip.id).value();
  EXPECT_EQ(lost.state, JobState::kInterrupted);
  EXPECT_GT(lost.end_ms, 0);
  EXPECT_EQ(lost.dip_status, "soak");
  EXPECT_TRUE(is_finished(lost.state));
  EXPECT_TRUE(jobs->remove(dip.id));
}

TEST_F(JobStoreTest, RecordOfADipIsAlwaysKept) {
  const Job dip = jobs->create(new_dip(), {}).value();
  ASSERT_TRUE(jobs->cancel(dip.id));
  ASSERT_TRUE(device_jobs->advance(dip.id, JobState::kRunning, "soak", {}, ""));
  EXPECT_EQ(jobs->get(dip.id)->state, JobState::kCancelling)
      << "a cancelled dip stays CANCELLING until its end";
  std::filesystem::create_directories(layout.artifacts(dip.id));
  std::ofstream(layout.artifacts(dip.id) / "report.json") << "{}";
  const JobFailure failure{
      {Code::kFailedPrecondition, "stalled", ErrorReason::RIG_FAULTED, {}}, {}, {}};
  ASSERT_TRUE(device_jobs->end(dip.id, JobState::kFailed, failure, "end",
                               {{"report.json", 2, "", "application/json"}}, ""));
  open();
  EXPECT_EQ(jobs->get(dip.id)->state, JobState::kFailed);
  EXPECT_EQ(jobs->get(dip.id)->failure->error.reason, ErrorReason::RIG_FAULTED);
  EXPECT_TRUE(jobs->artifact(dip.id, "report.json"));
  EXPECT_TRUE(std::filesystem::exists(layout.artifacts(dip.id) / "report.json"));
}

}  // namespace
}  // namespace hydroprint::daemon
