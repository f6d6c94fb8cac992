// Quotas and retention of jobs and assets.
#include "daemon/store/calibration_store.h"
#include "tests/daemon/store/store_fixture.h"

namespace hydroprint::daemon {
namespace {

constexpr std::int64_t kKeep_ms = 1000;  // retention in the options of the fixture

class Retention : public StoreTest {
 protected:
  Job dip(const std::string& owner = "ann") {
    NewJob definition;
    definition.owner = owner;
    definition.work.verb = "dip";
    definition.traits.computed = false;
    definition.dip_status = "first";
    const Job job = jobs->create(definition, {}).value();
    return device_jobs->end(job.id, JobState::kSucceeded, {}, "", {}, "").value();
  }
  Job done(const std::string& digest, const std::string& owner = "ann") {
    return complete(add(digest, owner).id);
  }
  [[nodiscard]] bool is_there(const Job& job) { return jobs->get(job.id).has_value(); }
  [[nodiscard]] std::int64_t purge_ms(const Job& job) { return jobs->get(job.id)->purge_ms; }
  void wait(std::int64_t ms) {
    now_ms += ms;
    ASSERT_TRUE(job_retention->purge());
  }
};

TEST_F(Retention, UnpinningRestartsRetention) {
  const Job pinned = done("1"), other = done("2");
  EXPECT_EQ(purge_ms(pinned), now_ms + kKeep_ms);
  const Job after = job_retention->pin(pinned.id, true).value();
  EXPECT_TRUE(after.pinned);
  EXPECT_GT(after.version, pinned.version);
  EXPECT_EQ(after.purge_ms, 0);
  wait(10 * kKeep_ms);
  EXPECT_TRUE(is_there(pinned));
  EXPECT_TRUE(std::filesystem::exists(layout.artifacts(pinned.id) / "film.png"));
  EXPECT_FALSE(is_there(other));
  EXPECT_FALSE(std::filesystem::exists(layout.artifacts(other.id)));
  EXPECT_EQ(job_retention->pin(pinned.id, false)->purge_ms, now_ms + kKeep_ms);
  wait(kKeep_ms - 1);
  EXPECT_TRUE(is_there(pinned));
  wait(1);
  EXPECT_FALSE(is_there(pinned));
}

TEST_F(Retention, JobPinnedBeforeItsEndIsKept) {
  const Job job = add("1");
  ASSERT_TRUE(job_retention->pin(job.id, true));
  complete(job.id);
  EXPECT_EQ(purge_ms(job), 0);
  wait(kKeep_ms);
  EXPECT_TRUE(is_there(job));
}

TEST_F(Retention, UnfinishedJobsAreNeverDeleted) {
  const Job queued = add("1"), running = add("2");
  ASSERT_TRUE(jobs->start(running.id));
  NewJob definition;
  definition.work.verb = "dip";
  definition.traits.computed = false;
  const Job waiting = jobs->create(definition, {}).value();
  wait(1LL << 50);
  for (const Job& job : {queued, running, waiting}) EXPECT_TRUE(is_there(job)) << job.id;
}

TEST_F(Retention, JobIsKeptAsLongAsItsCalibration) {
  CalibrationStore calibrations(*database, [this] { return now_ms; });
  const Job job = add("1");
  ASSERT_TRUE(jobs->start(job.id));
  NewCalibration definition;
  definition.job = job.id;
  ASSERT_TRUE(jobs->succeed(job.id, {}, definition));
  EXPECT_EQ(purge_ms(job), 0);
  wait(10 * kKeep_ms);
  ASSERT_TRUE(is_there(job));
  ASSERT_TRUE(calibrations.remove(1));
  wait(0);
  EXPECT_FALSE(is_there(job));
}

TEST_F(Retention, DipsAreKeptLonger) {
  retention_times.dips_ms = 5 * kKeep_ms;
  open();
  const Job dipped = dip(), other = done("1");
  EXPECT_EQ(purge_ms(dipped), now_ms + 5 * kKeep_ms);
  wait(5 * kKeep_ms - 1);
  EXPECT_FALSE(is_there(other));
  EXPECT_TRUE(is_there(dipped));
  wait(1);
  EXPECT_FALSE(is_there(dipped));
}

TEST_F(Retention, ZeroKeepsForEverAndChangesApplyAtTheNextStart) {
  retention_times.finished_ms = 0;
  open();
  const Job job = done("1"), dipped = dip();
  EXPECT_EQ(purge_ms(job), 0);
  EXPECT_EQ(purge_ms(dipped), 0);
  wait(100 * kKeep_ms);
  EXPECT_TRUE(is_there(job));
  const std::int64_t ended_ms = jobs->get(job.id)->end_ms;
  retention_times.finished_ms = 2 * kKeep_ms;
  open();
  EXPECT_EQ(purge_ms(job), ended_ms + 2 * kKeep_ms);
  wait(0);
  EXPECT_FALSE(is_there(job));
}

TEST_F(Retention, NothingIsDeletedDuringAPrint) {
  const Job old = done("1");
  NewJob definition;
  definition.work.verb = "print";
  definition.traits = {false, true, ""};
  const Job print = jobs->create(definition, {}).value();
  wait(kKeep_ms);
  EXPECT_TRUE(is_there(old));  // the print may be reading the artifacts of this job
  ASSERT_TRUE(device_jobs->end(print.id, JobState::kSucceeded, {}, "", {}, ""));
  wait(0);
  EXPECT_FALSE(is_there(old));
  EXPECT_TRUE(is_there(print));
}

constexpr std::int64_t kYear_ms = 365LL * 24 * 3600 * 1000;

TEST_F(Retention, ClockJumpAheadAndBackDeletesNothing) {
  keep_unused_ms = 1000;
  open();
  const Job before = done("1");
  const std::int64_t due_ms = purge_ms(before);
  ASSERT_TRUE(job_retention->purge());
  now_ms += 3 * kYear_ms;
  open();
  ASSERT_TRUE(job_retention->purge());
  EXPECT_TRUE(is_there(before));
  EXPECT_EQ(purge_ms(before), due_ms + 3 * kYear_ms);
  const Job meanwhile = done("2");
  now_ms -= 3 * kYear_ms;
  open();
  ASSERT_TRUE(job_retention->purge());
  EXPECT_EQ(purge_ms(before), due_ms);
  EXPECT_EQ(purge_ms(meanwhile), due_ms);
  wait(kKeep_ms);
  EXPECT_FALSE(is_there(before));
  EXPECT_FALSE(is_there(meanwhile));
}

TEST_F(Retention, ClockJumpKeepsUnusedAssetsAndOpenUploads) {
  keep_unused_ms = 1000;
  open();
  const auto started = uploads->start({"", sha256("part"), 4, 0, "", 0}, {"ann", false}, {});
  const std::string id = std::get<Upload>(started.value()).id;
  std::ofstream(layout.root / "mesh") << "mesh";
  ASSERT_TRUE(assets->adopt(layout.root / "mesh", {sha256("mesh"), 4, "", 0}));
  now_ms += 3 * kYear_ms;
  open();
  EXPECT_TRUE(uploads->get(id, "ann"));
  EXPECT_TRUE(select_asset(*database, sha256("mesh")));
  now_ms += 1000;
  ASSERT_TRUE(asset_retention->purge());
  EXPECT_FALSE(uploads->get(id, "ann"));
  EXPECT_FALSE(select_asset(*database, sha256("mesh")));
}

TEST_F(Retention, StepsOfOneDayCount) {
  const Job job = done("1");
  ASSERT_TRUE(job_retention->purge());
  wait(24LL * 3600 * 1000);
  EXPECT_FALSE(is_there(job));
}

TEST_F(Retention, OldestAreDeletedFirst) {
  const Job first = add("1"), second = done("2");
  now_ms += 10;
  complete(first.id);  // the first job ends last
  ASSERT_TRUE(database->run("CREATE TABLE gone(job INTEGER)"));
  ASSERT_TRUE(database->run(
      "CREATE TRIGGER note AFTER DELETE ON jobs BEGIN INSERT INTO gone VALUES (old.id); END"));
  wait(kKeep_ms);
  std::vector<std::int64_t> gone;
  ASSERT_TRUE(database->each("SELECT job FROM gone ORDER BY rowid", {},
                             [&](const DbRow& row) { gone.push_back(row.integer(0)); }));
  EXPECT_EQ(gone, (std::vector<std::int64_t>{second.id, first.id}));
}

TEST_F(Retention, QueueLimitAppliesToEachOwner) {
  job_options.quota.max_queued_jobs = 2;
  open();
  add("1");
  const Job second = add("2");
  NewJob definition;
  definition.owner = "ann";
  definition.work.verb = "simulate";
  const auto refused = jobs->create(definition, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::kResourceExhausted);
  EXPECT_EQ(refused.error().reason, ErrorReason::QUOTA_EXCEEDED);
  EXPECT_EQ(refused.error().metadata.at("quota"), "jobs");
  EXPECT_EQ(refused.error().metadata.at("used"), "2");
  EXPECT_EQ(refused.error().metadata.at("allowed"), "2");
  add("3", "bob");
  ASSERT_TRUE(jobs->start(second.id));  // a running job no longer counts as queued
  EXPECT_TRUE(jobs->create(definition, {}));
}

TEST_F(Retention, JobsAreAcceptedBelowTheByteQuota) {
  job_options.quota.max_stored_bytes = 6;
  open();
  const Job first = done("1");  // 4 bytes
  const Job second = done("2");
  EXPECT_EQ(usage_of(*database, "ann")->stored_bytes, 8);
  NewJob definition;
  definition.owner = "ann";
  for (const char* const verb : {"simulate", "dip", "print", "capture"}) {
    definition.work.verb = verb;
    definition.traits.computed = definition.work.verb == "simulate";
    const auto refused = jobs->create(definition, {});
    ASSERT_FALSE(refused) << verb;
    EXPECT_EQ(refused.error().reason, ErrorReason::QUOTA_EXCEEDED);
    EXPECT_EQ(refused.error().metadata.at("quota"), "bytes");
  }
  ASSERT_TRUE(job_retention->pin(second.id, true));
  EXPECT_EQ(usage_of(*database, "ann")->pinned_bytes, 4);
  add("3", "bob");
  ASSERT_TRUE(jobs->remove(first.id));
  add("4");
}

}  // namespace
}  // namespace hydroprint::daemon
