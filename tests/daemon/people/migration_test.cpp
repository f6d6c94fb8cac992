// Stores that earlier versions made.
#include <gtest/gtest.h>

#include "daemon/job_store.h"
#include "daemon/people/accounts.h"
#include "daemon/schema.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

// As version 1 made it; never to be changed.
constexpr const char* kVersion1 = R"sql(
CREATE TABLE IF NOT EXISTS settings(name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
INSERT OR IGNORE INTO settings VALUES ('schema', '1');
CREATE TABLE IF NOT EXISTS jobs(
  id INTEGER PRIMARY KEY AUTOINCREMENT, uid TEXT NOT NULL, display_name TEXT NOT NULL,
  owner TEXT NOT NULL, priority INTEGER NOT NULL, rank INTEGER NOT NULL, body BLOB NOT NULL,
  verb TEXT NOT NULL, flags TEXT NOT NULL, pose TEXT NOT NULL, threads INTEGER NOT NULL, digest TEXT NOT NULL,
  retry_of INTEGER NOT NULL, use_cache INTEGER NOT NULL, cache_hit INTEGER NOT NULL DEFAULT 0,
  state INTEGER NOT NULL, fraction REAL NOT NULL DEFAULT 0, phase TEXT NOT NULL DEFAULT '',
  phase_fraction REAL NOT NULL DEFAULT 0, eta_ms INTEGER NOT NULL DEFAULT 0,
  create_ms INTEGER NOT NULL, start_ms INTEGER NOT NULL DEFAULT 0, end_ms INTEGER NOT NULL DEFAULT 0,
  update_ms INTEGER NOT NULL, purge_ms INTEGER NOT NULL DEFAULT 0, version INTEGER NOT NULL DEFAULT 1,
  error_code INTEGER, error_reason TEXT, error_message TEXT, exit_status INTEGER, signal INTEGER);
CREATE INDEX IF NOT EXISTS jobs_by_state ON jobs(state);
CREATE INDEX IF NOT EXISTS jobs_by_digest ON jobs(digest);
CREATE TABLE IF NOT EXISTS job_inputs(
  job INTEGER NOT NULL REFERENCES jobs(id) ON DELETE CASCADE, name TEXT NOT NULL,
  sha256 TEXT NOT NULL, PRIMARY KEY(job, name)) WITHOUT ROWID;
CREATE INDEX IF NOT EXISTS inputs_by_hash ON job_inputs(sha256);
CREATE TABLE IF NOT EXISTS events(
  seq INTEGER PRIMARY KEY AUTOINCREMENT,
  job INTEGER NOT NULL REFERENCES jobs(id) ON DELETE CASCADE, time_ms INTEGER NOT NULL,
  kind INTEGER NOT NULL, state INTEGER NOT NULL, fraction REAL NOT NULL, phase TEXT NOT NULL,
  phase_fraction REAL NOT NULL, eta_ms INTEGER NOT NULL, message TEXT NOT NULL);
CREATE INDEX IF NOT EXISTS events_by_job ON events(job, seq);
CREATE TABLE IF NOT EXISTS artifacts(
  job INTEGER NOT NULL REFERENCES jobs(id) ON DELETE CASCADE, name TEXT NOT NULL,
  size INTEGER NOT NULL, sha256 TEXT NOT NULL, media_type TEXT NOT NULL,
  PRIMARY KEY(job, name)) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS assets(
  sha256 TEXT PRIMARY KEY, size INTEGER NOT NULL, media_type TEXT NOT NULL,
  create_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS uploads(
  id TEXT PRIMARY KEY, sha256 TEXT NOT NULL, size INTEGER NOT NULL, media_type TEXT NOT NULL,
  expire_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS losses(
  job INTEGER PRIMARY KEY REFERENCES jobs(id) ON DELETE CASCADE, count INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS dips(
  job INTEGER PRIMARY KEY REFERENCES jobs(id) ON DELETE CASCADE, status BLOB NOT NULL);
CREATE TABLE IF NOT EXISTS lease(
  one INTEGER PRIMARY KEY CHECK(one=1), id TEXT NOT NULL, holder TEXT NOT NULL,
  purpose TEXT NOT NULL, acquire_ms INTEGER NOT NULL, expire_ms INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS calibrations(
  id INTEGER PRIMARY KEY AUTOINCREMENT, kind INTEGER NOT NULL, owner TEXT NOT NULL,
  job INTEGER NOT NULL, capture INTEGER NOT NULL, active INTEGER NOT NULL,
  create_ms INTEGER NOT NULL, body BLOB NOT NULL);
CREATE INDEX IF NOT EXISTS calibrations_by_job ON calibrations(job);
CREATE TABLE IF NOT EXISTS captures(
  job INTEGER PRIMARY KEY, time_ms INTEGER NOT NULL, watched INTEGER NOT NULL,
  homed INTEGER NOT NULL, axis_mm REAL NOT NULL, homings INTEGER NOT NULL, dips INTEGER NOT NULL);
CREATE TABLE IF NOT EXISTS requests(
  owner TEXT NOT NULL, method TEXT NOT NULL, id TEXT NOT NULL, digest TEXT NOT NULL,
  result TEXT NOT NULL, time_ms INTEGER NOT NULL, PRIMARY KEY(owner, method, id)) WITHOUT ROWID;
)sql";

class Migration : public ::testing::Test {
 protected:
  // A store of version 1 with one job and the lease.
  void make_version_1() {
    const auto database = Database::open(layout.database(), kVersion1).value();
    ASSERT_TRUE(
        database->run("INSERT INTO jobs(uid, display_name, owner, priority, rank, body, verb, "
                      "flags, pose, threads, "
                      "digest, retry_of, use_cache, state, create_ms, update_ms) VALUES "
                      "('u', 'old', 'ann', 0, 1, '', 'simulate', '', '', 0, 'd', 0, 1, 5, 7, 7)"));
    ASSERT_TRUE(database->run("INSERT INTO lease VALUES (1, 'l', 'ann', 'p', 1, 2)"));
  }
  static std::string version_of(Database& database) {
    std::string version;
    EXPECT_TRUE(database.each("SELECT value FROM settings WHERE name='schema'", {},
                              [&](const DbRow& row) { version = row.text(0); }));
    return version;
  }

  hydroprint::testing::TemporaryFolder folder;
  Layout layout{folder.path()};
};

TEST_F(Migration, AStoreOfVersion1KeepsWhatItHasAndTakesPeople) {
  make_version_1();
  for (int i = 0; i < 2; ++i) {  // once migrated it is opened as it is
    const auto database = open_store(layout.database());
    ASSERT_TRUE(database) << database.error().message;
    EXPECT_EQ(version_of(**database), "2");
    JobStore jobs(**database, layout, {}, system_clock_ms);
    const Job job = jobs.get(1).value();
    EXPECT_EQ(job.made.display_name, "old");
    EXPECT_FALSE(job.shared);
    const auto accounts = people::Accounts::open(**database, {}, system_clock_ms).value();
    if (i == 0) {
      EXPECT_FALSE(accounts->any());
      EXPECT_TRUE(accounts->create({"ann", people::Role::kAdmin, false, "", 0}, ""));
      EXPECT_TRUE(jobs.share(1, true)->shared);
      EXPECT_TRUE(jobs.share(1, false));
    } else {
      EXPECT_TRUE(accounts->any());
    }
  }
}

TEST_F(Migration, ANewStoreIsOfTheLatestVersion) {
  EXPECT_EQ(version_of(**open_store(layout.database())), "2");
}

TEST_F(Migration, AStoreOfALaterVersionIsRefusedAndLeftAsItIs) {
  {
    const auto database = open_store(layout.database()).value();
    ASSERT_TRUE(database->run("UPDATE settings SET value='3' WHERE name='schema'"));
  }
  const auto refused = open_store(layout.database());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, "STORE_TOO_NEW");
  EXPECT_NE(refused.error().message.find("hydroprint.db"), std::string::npos);
  EXPECT_EQ(version_of(*Database::open(layout.database(), "").value()), "3");
}

TEST_F(Migration, OneThatFailsLeavesTheStoreAsItWas) {
  make_version_1();
  {
    const auto database = Database::open(layout.database(), "").value();
    ASSERT_TRUE(database->run("CREATE TABLE audit(in_the_way)"));
  }
  EXPECT_FALSE(open_store(layout.database()));
  const auto database = Database::open(layout.database(), "").value();
  EXPECT_EQ(version_of(*database), "1");
  EXPECT_TRUE(database->run("DROP TABLE audit"));
  EXPECT_EQ(version_of(**open_store(layout.database())), "2");
}

}  // namespace
}  // namespace hydroprint::daemon
