#include "daemon/auth/audit_log.h"

#include <gtest/gtest.h>

#include "tests/daemon/auth/accounts_fixture.h"

namespace hydroprint::auth {
namespace {

class Audit : public PeopleTest {
 protected:
  static AuditEntry entry(const std::string& who, const std::string& what) {
    AuditEntry out;
    out.who = who;
    out.what = what;
    out.outcome = "OK";
    return out;
  }
  std::unique_ptr<AuditLog> make() {
    return std::make_unique<AuditLog>(*database, [this] { return now_ms; });
  }
};

TEST_F(Audit, EntriesArePagedNewestFirst) {
  const auto log = make();
  for (int i = 0; i < 5; ++i) log->note(entry("ann", "RigService.Arm" + std::to_string(i)));
  const auto page = log->list({"", "", 0, 3}).value();
  ASSERT_EQ(page.size(), 3U);
  EXPECT_EQ(page.front().what, "RigService.Arm4");
  EXPECT_EQ(page.front().time_ms, now_ms);
  const auto rest = log->list({"", "", page.back().seq, 3}).value();
  ASSERT_EQ(rest.size(), 2U);
  EXPECT_EQ(rest.back().what, "RigService.Arm0");
}

TEST_F(Audit, EntriesAreFilteredByCallerAndMethod) {
  const auto log = make();
  log->note(entry("ann", "RigService.Arm"));
  log->note(entry("bob", "RigService.Home"));
  log->note(entry("bob", "JobService.CancelJob"));
  EXPECT_EQ(log->list({"bob", "", 0, 10})->size(), 2U);
  EXPECT_EQ(log->list({"bob", "RigService.", 0, 10})->size(), 1U);
  EXPECT_EQ(log->list({"", "RigService.", 0, 10})->size(), 2U);
  EXPECT_EQ(log->list({"", "%", 0, 10})->size(), 0U);
}

TEST_F(Audit, EntriesAreWrittenAtShutdown) {
  make()->note(entry("ann", "RigService.Arm"));
  open();
  EXPECT_EQ(make()->list({"", "", 0, 10})->size(), 1U);
}

TEST_F(Audit, WaitEndsWhenTheEntryIsOnDisk) {
  const auto log = make();
  const auto reader = daemon::Database::open(folder.path() / "hydroprint.db", "").value();
  for (int i = 1; i <= 20; ++i) {
    EXPECT_TRUE(
        log->wait_written(log->note(entry("ann", "RigService.Arm")), std::chrono::hours(1)));
    std::int64_t count = 0;
    ASSERT_TRUE(reader->each("SELECT count(*) FROM audit", {},
                             [&](const daemon::DbRow& row) { count = row.integer(0); }));
    EXPECT_EQ(count, i);
  }
}

TEST_F(Audit, WaitForAHangingStoreTimesOut) {
  const auto log = make();
  const auto other = daemon::Database::open(folder.path() / "hydroprint.db", "").value();
  ASSERT_TRUE(other->run("BEGIN IMMEDIATE"));
  EXPECT_FALSE(
      log->wait_written(log->note(entry("ann", "RigService.Arm")), std::chrono::milliseconds(50)));
  ASSERT_TRUE(other->run("COMMIT"));
  // The entry is written once the store responds.
  EXPECT_EQ(log->list({"", "", 0, 10})->size(), 1U);
}

TEST_F(Audit, FailingStoreEndsTheWaitAtOnce) {
  const auto log = make();
  ASSERT_TRUE(database->run("ALTER TABLE audit RENAME TO away"));
  EXPECT_FALSE(log->wait_written(log->note(entry("ann", "RigService.Arm")), std::chrono::hours(1)));
  ASSERT_TRUE(database->run("ALTER TABLE away RENAME TO audit"));
  log->note(entry("ann", "RigService.Home"));
  const auto entries = log->list({"", "", 0, 10}).value();
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[1].outcome, "DATA_LOSS");  // an entry reports the loss
}

TEST_F(Audit, EntriesAreKeptForAYear) {
  const auto log = make();
  const auto pass_days = [&](int days) {
    for (int i = 0; i < days; ++i) {
      now_ms += 24 * kHour_ms;
      ASSERT_TRUE(log->clean_up());
    }
  };
  log->note(entry("ann", "first"));
  ASSERT_EQ(log->list({"", "", 0, 10})->size(), 1U);
  pass_days(364);
  log->note(entry("ann", "second"));
  ASSERT_EQ(log->list({"", "", 0, 10})->size(), 2U);
  ASSERT_TRUE(log->clean_up());
  EXPECT_EQ(log->list({"", "", 0, 10})->size(), 2U);
  pass_days(2);
  ASSERT_EQ(log->list({"", "", 0, 10})->size(), 1U);
  EXPECT_EQ(log->list({"", "", 0, 10})->front().what, "second");
}

TEST_F(Audit, ClockJumpDeletesNoEntry) {
  const auto log = make();
  log->note(entry("ann", "first"));
  ASSERT_TRUE(log->clean_up());
  now_ms += 3 * 365 * 24 * kHour_ms;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(log->clean_up());
    now_ms += kHour_ms;
  }
  EXPECT_EQ(log->list({"", "", 0, 10})->size(), 1U);
}

}  // namespace
}  // namespace hydroprint::auth
