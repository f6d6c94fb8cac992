// The plans of the queries that calls and workers make: none reads a table as long as the history.
#include "daemon/store/calibration_store.h"
#include "tests/daemon/store/store_fixture.h"

namespace hydroprint::daemon {
namespace {

// Tables that grow with the number of jobs or files, and an alias. The others have few rows.
const std::set<std::string> kLong{"jobs",   "events",       "artifacts", "job_inputs",
                                  "assets", "asset_owners", "o",         "requests"};

class QueryPlans : public StoreTest {
 protected:
  QueryPlans() {
    job_options.quota = {100, 1'000'000'000};
    upload_options.quota = job_options.quota;
    // An earlier history, mostly of one owner.
    fill(
        "INSERT INTO jobs(uid, display_name, owner, priority, rank, body, verb, spec, computed, "
        "reads_artifacts, interrupted_advice, threads, digest, retry_of, use_cache, state, "
        "create_ms, update_ms, end_ms) SELECT 'u', '', iif(i%10=0, 'bob', 'ann'), 0, i, '', "
        "'simulate', '', 1, 0, '', 0, 'old ' || i, 0, 1, 5, i, i, i FROM n");
    fill(
        "INSERT INTO events(job, time_ms, kind, state, fraction, phase, phase_fraction, eta_ms, "
        "message) SELECT i, i, 1, 5, 1, '', 0, 0, '' FROM n");
    fill("INSERT INTO artifacts SELECT i, 'film.png', 4, 'x', 'image/png' FROM n");
    fill("INSERT INTO assets SELECT 'asset ' || i, 4, 'x/y', i, i FROM n");
    fill("INSERT INTO asset_owners SELECT 'ann', 'asset ' || i, i FROM n");
    fill("INSERT INTO job_inputs SELECT i, 'm.obj', 'asset ' || i FROM n");
    open_stores();
  }
  void fill(const std::string& sql) {
    ASSERT_TRUE(database->run(
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i+1 FROM n WHERE i<2000) " + sql));
  }
  [[nodiscard]] std::string plan_of(const std::string& sql) {
    std::string plan;
    EXPECT_TRUE(database->each("EXPLAIN QUERY PLAN " + sql, {}, [&](const DbRow& row) {
      plan += row.text(3) + "\n";
    })) << sql;
    return plan;
  }
  /// Expects that one statement with this text has run, and that its plan contains `search`.
  void expect_plan(const std::string& text, const std::string& search) {
    int found = 0;
    for (const std::string& sql : database->statements()) {
      if (sql.find(text) == std::string::npos || sql.starts_with("EXPLAIN")) continue;
      ++found;
      const std::string plan = plan_of(sql);
      EXPECT_NE(plan.find(search), std::string::npos) << sql << "\n" << plan;
    }
    EXPECT_EQ(found, 1) << text;
  }
  void make_lists() {
    const std::vector<JobState> open{JobState::kQueued, JobState::kRunning};
    const std::vector<JobState> ended{JobState::kSucceeded, JobState::kFailed};
    for (const char* const owner : {"", "ann"}) {
      for (const std::int64_t before : {0, 1000}) {
        for (const auto& states : {std::vector<JobState>(), open, ended}) {
          EXPECT_TRUE(jobs->list({states, owner, before, 50}));
        }
      }
      EXPECT_EQ(assets->list("", 50, owner)->size(), 50U);
    }
    EXPECT_EQ(jobs->list({{}, "bob", 0, 50})->size(), 50U);
    EXPECT_EQ(jobs->list({ended, "bob", 1000, 50})->size(), 50U);
  }
  void use_jobs() {
    const Job job = add("new");
    ASSERT_TRUE(jobs->start(job.id, "local"));
    ASSERT_TRUE(jobs->note_handle({job.id, 1, "local", "h", ""}));
    ASSERT_TRUE(jobs->report(job.id, {0.5, "velocity", 0.1, 0}));
    ASSERT_TRUE(jobs->succeed(job.id, {{"film.png", 4, sha256("film"), "image/png"}},
                              NewCalibration{CalibrationKind::kObject, "ann", job.id, 0, ""}));
    ASSERT_TRUE(jobs->artifacts(job.id, "", 50));
    ASSERT_TRUE(jobs->artifact(job.id, "film.png"));
    ASSERT_TRUE(jobs->events(job.id, 0, 100));
    ASSERT_TRUE(jobs->all_events(0, 100));
    ASSERT_TRUE(jobs->share(job.id, true));
    ASSERT_TRUE(job_retention->pin(job.id, true));
    ASSERT_TRUE(job_retention->pin(job.id, false));
    ASSERT_TRUE(jobs->remove(1));
    ASSERT_TRUE(jobs->cancel(add("2").id));
    const Job failed = add("3"), moved = add("4");
    ASSERT_TRUE(jobs->start(failed.id));
    ASSERT_TRUE(jobs->interrupt(failed.id, Interruption::kWorkerLoss));
    ASSERT_TRUE(jobs->start(failed.id));
    ASSERT_TRUE(jobs->give_up(failed.id, {{Code::kInternal, "it broke"}, 4, {}}));
    ASSERT_TRUE(queue->move(moved.id, 0));
    ASSERT_TRUE(queue->waiting());
    ASSERT_TRUE(queue->computing());
    ASSERT_TRUE(queue->pause());
    ASSERT_TRUE(jobs->executions());
    for (const JobState state : {JobState::kQueued, JobState::kRunning}) {
      ASSERT_TRUE(jobs->ids_in_state(state));
    }
  }
  void use_dip() {
    NewJob definition;
    definition.owner = "ann";
    definition.work.verb = "dip";
    definition.traits.computed = false;
    definition.dip_status = "first";
    const Job job = jobs->create(definition, {"CreateJob", "id", "x"}).value();
    ASSERT_TRUE(device_jobs->open_dips());
    ASSERT_TRUE(device_jobs->advance(job.id, JobState::kRunning, "next", {}, ""));
    ASSERT_TRUE(device_jobs->end(job.id, JobState::kSucceeded, {}, "last", {}, ""));
  }
  void use_files() {
    const AssetUser ann{"ann"}, bob{"bob"}, oper{"oper", true};
    const auto begun = uploads->start({"", sha256("mesh"), 4, 0, "x/y", 0}, ann, {});
    const auto writer = UploadWriter::open(*uploads, std::get<Upload>(*begun).id, "ann").value();
    ASSERT_TRUE(writer->append(0, "mesh"));
    ASSERT_TRUE(writer->finish());
    ASSERT_TRUE(uploads->start({"", sha256("mesh"), 4, 0, "x/y", 0}, ann, {}));
    ASSERT_FALSE(assets->asset_for(sha256("mesh"), bob));
    ASSERT_TRUE(check_may_use(*database, {{"m.obj", sha256("mesh")}}, ann));
    ASSERT_FALSE(assets->remove("asset 7", ann));
    ASSERT_TRUE(assets->remove("asset 7", oper));
  }
  void use_calibrations() {
    CalibrationStore calibrations(*database, [this] { return now_ms; });
    for (const std::int64_t before : {0, 1000}) ASSERT_TRUE(calibrations.list(before, 50));
  }
};

TEST_F(QueryPlans, NoFrequentQueryReadsAWholeTable) {
  std::filesystem::create_directories(layout.uploads());
  make_lists();
  use_jobs();
  use_dip();
  use_files();
  use_calibrations();
  int queries = 0;
  for (const std::string& sql : database->statements()) {
    const std::string verb = sql.substr(0, sql.find(' '));
    if (verb != "SELECT" && verb != "INSERT" && verb != "UPDATE" && verb != "DELETE") continue;
    ++queries;
    const std::string plan = plan_of(sql);
    for (const std::string& table : kLong) {
      EXPECT_EQ(plan.find("SCAN " + table + "\n"), std::string::npos) << sql << "\n" << plan;
      EXPECT_EQ(plan.find("SCAN " + table + " "), std::string::npos) << sql << "\n" << plan;
    }
  }
  EXPECT_GT(queries, 40);
}

// An index that finds most of the history is as slow as none.
TEST_F(QueryPlans, IndexesFindOnlyWhatIsAskedFor) {
  const Job job = add("new");
  expect_plan("digest=? AND +state=?", "jobs_by_digest (digest=?)");
  expect_plan("artifact_bytes", "jobs_by_state (state=?)");
  expect_plan("artifact_bytes", "SEARCH artifact_bytes USING PRIMARY KEY (owner=?)");
  ASSERT_TRUE(jobs->list({{}, "", 1000, 50}));
  expect_plan("WHERE id<?2 ORDER", "INTEGER PRIMARY KEY (rowid<?)");
  ASSERT_TRUE(jobs->list({{}, "bob", 1000, 50}));
  expect_plan("WHERE owner=?1 AND id<?2 ORDER", "jobs_by_owner (owner=? AND rowid<?)");
  ASSERT_TRUE(jobs->list({{JobState::kSucceeded}, "", 1000, 50}));
  expect_plan("WHERE state=5 AND id<?2", "jobs_by_state (state=? AND rowid<?)");
  ASSERT_TRUE(jobs->list({{JobState::kQueued, JobState::kSucceeded}, "bob", 1000, 50}));
  expect_plan("WHERE state=1 AND +owner=?1", "jobs_by_state (state=? AND rowid<?)");
  expect_plan("WHERE state=1 AND +owner=?1", "jobs_by_owner (owner=? AND rowid<?)");
  ASSERT_TRUE(jobs->events(job.id, 0, 50));
  expect_plan("WHERE job=? AND seq>?", "events_by_job (job=? AND seq>?)");
  ASSERT_TRUE(jobs->all_events(0, 50));
  expect_plan("WHERE seq>?", "INTEGER PRIMARY KEY (rowid>?)");
}

TEST_F(QueryPlans, ListsAreTheNewestJobsOfTheFilter) {
  const auto ids = [&](const JobFilter& filter) {
    std::vector<std::int64_t> out;
    const auto found = jobs->list(filter);
    for (const Job& job : *found) out.push_back(job.id);
    return out;
  };
  const std::int64_t queued = add("new", "bob").id;
  const std::vector<JobState> both{JobState::kQueued, JobState::kSucceeded, JobState::kQueued};
  EXPECT_EQ(ids({{}, "", 0, 2}), (std::vector<std::int64_t>{queued, 2000}));
  EXPECT_EQ(ids({{}, "bob", 2000, 2}), (std::vector<std::int64_t>{1990, 1980}));
  EXPECT_EQ(ids({both, "", 0, 3}), (std::vector<std::int64_t>{queued, 2000, 1999}));
  EXPECT_EQ(ids({both, "bob", 0, 3}), (std::vector<std::int64_t>{queued, 2000, 1990}));
  EXPECT_EQ(ids({{JobState::kQueued}, "ann", 0, 3}), std::vector<std::int64_t>());
  EXPECT_EQ(ids({{JobState::kSucceeded}, "ann", 12, 5}),
            (std::vector<std::int64_t>{11, 9, 8, 7, 6}));
}

}  // namespace
}  // namespace hydroprint::daemon
