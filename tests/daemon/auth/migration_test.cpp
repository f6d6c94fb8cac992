// Migration of stores of earlier versions.
#include <gtest/gtest.h>

#include <array>

#include "daemon/auth/accounts.h"
#include "daemon/auth/audit_log.h"
#include "daemon/store/assets/asset_retention.h"
#include "daemon/store/assets/asset_rows.h"
#include "daemon/store/assets/asset_store.h"
#include "daemon/store/database/schema.h"
#include "daemon/store/device_jobs.h"
#include "daemon/store/job_queue.h"
#include "daemon/store/job_retention.h"
#include "daemon/store/job_store.h"
#include "tests/support/temporary_folder.h"

namespace hydroprint::daemon {
namespace {

// Schema of version 1; must never change.
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

// Changes of version 2; must never change.
constexpr std::array kVersion2{
    "CREATE TABLE users(name TEXT PRIMARY KEY, role INTEGER NOT NULL, disabled INTEGER NOT NULL, "
    "password TEXT NOT NULL, create_ms INTEGER NOT NULL) WITHOUT ROWID",
    "CREATE TABLE api_keys(id TEXT PRIMARY KEY, "
    "user TEXT NOT NULL REFERENCES users(name) ON DELETE CASCADE, display_name TEXT NOT NULL, "
    "secret_hash TEXT NOT NULL, role INTEGER NOT NULL, create_ms INTEGER NOT NULL, "
    "expire_ms INTEGER NOT NULL, use_ms INTEGER NOT NULL) WITHOUT ROWID",
    "CREATE TABLE sessions(id TEXT PRIMARY KEY, "
    "user TEXT NOT NULL REFERENCES users(name) ON DELETE CASCADE, "
    "token_hash TEXT NOT NULL UNIQUE, peer TEXT NOT NULL, create_ms INTEGER NOT NULL, "
    "use_ms INTEGER NOT NULL) WITHOUT ROWID",
    "CREATE TABLE sign_in_links(token_hash TEXT PRIMARY KEY, "
    "user TEXT NOT NULL REFERENCES users(name) ON DELETE CASCADE, expire_ms INTEGER NOT NULL) "
    "WITHOUT ROWID",
    "CREATE TABLE audit(seq INTEGER PRIMARY KEY AUTOINCREMENT, time_ms INTEGER NOT NULL, "
    "who TEXT NOT NULL, via TEXT NOT NULL, peer TEXT NOT NULL, what TEXT NOT NULL, "
    "object TEXT NOT NULL, outcome TEXT NOT NULL, detail TEXT NOT NULL)",
    "CREATE INDEX audit_by_time ON audit(time_ms)",
    "ALTER TABLE jobs ADD COLUMN shared INTEGER NOT NULL DEFAULT 0",
    "UPDATE settings SET value='2' WHERE name='schema'"};

// Changes of version 3; must never change.
constexpr std::array kVersion3{
    "CREATE TABLE asset_owners(owner TEXT NOT NULL, "
    "sha256 TEXT NOT NULL REFERENCES assets(sha256) ON DELETE CASCADE, "
    "create_ms INTEGER NOT NULL, PRIMARY KEY(owner, sha256)) WITHOUT ROWID",
    "CREATE INDEX owners_by_asset ON asset_owners(sha256)",
    "ALTER TABLE assets ADD COLUMN use_ms INTEGER NOT NULL DEFAULT 0",
    "ALTER TABLE uploads ADD COLUMN owner TEXT NOT NULL DEFAULT ''",
    "ALTER TABLE jobs ADD COLUMN pinned INTEGER NOT NULL DEFAULT 0",
    "ALTER TABLE jobs ADD COLUMN keep_from_ms INTEGER NOT NULL DEFAULT 0",
    "CREATE INDEX jobs_by_owner ON jobs(owner)",
    "CREATE TABLE former_users(name TEXT PRIMARY KEY, delete_ms INTEGER NOT NULL) WITHOUT ROWID",
    "UPDATE settings SET value='3' WHERE name='schema'"};
constexpr const char* kLatest = "5";

constexpr std::int64_t kMonth_ms = 30LL * 24 * 3600 * 1000;

// Rows of a used store of version 2, in each of its tables: ann's finished job 1 with an asset,
// bea's queued job 2 with the same asset, and an unused asset.
constexpr std::array kUsed{
    "INSERT INTO assets VALUES ('aa', 4, 'model/obj', 5), ('bb', 6, 'image/png', 5)",
    "INSERT INTO uploads VALUES ('u1', 'cc', 9, '', 99999999999999)",
    "INSERT INTO jobs(uid, display_name, owner, priority, rank, body, verb, flags, pose, threads, "
    "digest, retry_of, use_cache, state, create_ms, end_ms, update_ms, purge_ms, shared) VALUES "
    "('u', 'old', 'ann', 0, 1, 'b', 'simulate', '--dpi=300', '', 0, 'd', 0, 1, 5, 7, 8, 8, 9, 1), "
    "('v', 'new', 'bea', 0, 2, 'b', 'simulate', '', '', 0, 'e', 0, 1, 1, 7, 0, 7, 0, 0)",
    "INSERT INTO job_inputs VALUES (1, 'm.obj', 'aa'), (2, 'm.obj', 'aa')",
    "INSERT INTO artifacts VALUES (1, 'film.png', 4, 'ff', 'image/png')",
    "INSERT INTO events(job, time_ms, kind, state, fraction, phase, phase_fraction, eta_ms, "
    "message) VALUES (1, 8, 1, 5, 1, '', 0, 0, '')",
    "INSERT INTO lease VALUES (1, 'l', 'ann', 'p', 1, 2)",
    "INSERT INTO users VALUES ('ann', 4, 0, 'hash', 1), ('bea', 2, 1, '', 2)",
    "INSERT INTO api_keys VALUES ('k', 'ann', 'nightly', 'h', 2, 1, 0, 0)",
    "INSERT INTO sessions VALUES ('s', 'ann', 't', '127.0.0.1', 1, 2)",
    "INSERT INTO audit(time_ms, who, via, peer, what, object, outcome, detail) VALUES "
    "(1, 'ann', 'session', '', 'RigService.MoveTo', '', 'OK', 'position_mm 5')"};

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
  // A used store of version 2.
  void make_version_2() {
    const auto database = Database::open(layout.database(), kVersion1).value();
    for (const char* const statement : kVersion2) ASSERT_TRUE(database->run(statement));
    for (const char* const statement : kUsed) {
      const Status done = database->run(statement);
      ASSERT_TRUE(done) << statement << ": " << done.error().message;
    }
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

TEST_F(Migration, Version1KeepsItsDataAndAcceptsUsers) {
  make_version_1();
  for (int i = 0; i < 2; ++i) {  // the second time, the store opens without changes
    const auto database = open_store(layout.database());
    ASSERT_TRUE(database) << database.error().message;
    EXPECT_EQ(version_of(**database), kLatest);
    JobChanges changes(**database, {}, system_clock_ms);
    JobStore jobs(changes, layout, {});
    const Job job = jobs.get(1).value();
    EXPECT_EQ(job.definition.display_name, "old");
    EXPECT_FALSE(job.shared);
    const auto accounts = auth::Accounts::open(**database, {}, system_clock_ms).value();
    if (i == 0) {
      EXPECT_FALSE(accounts->users().any());
      EXPECT_TRUE(accounts->users().create({"ann", auth::Role::kAdmin, false, "", 0}, ""));
      EXPECT_TRUE(jobs.share(1, true)->shared);
      EXPECT_TRUE(jobs.share(1, false));
    } else {
      EXPECT_TRUE(accounts->users().any());
    }
  }
}

TEST_F(Migration, Version2KeepsItsDataAndAssetsGetOwners) {
  make_version_2();
  for (int i = 0; i < 2; ++i) {
    const auto database = open_store(layout.database()).value();
    EXPECT_EQ(version_of(*database), kLatest);
    JobChanges changes(*database, {}, system_clock_ms);
    JobStore jobs(changes, layout, {});
    JobRetention retention(changes, layout);
    AssetStore assets(*database, layout, system_clock_ms);
    const Job job = jobs.get(1).value();
    EXPECT_EQ(job.definition.display_name, "old");
    EXPECT_EQ(job.definition.work.flags, std::vector<std::string>{"--dpi=300"});
    EXPECT_EQ(job.state, JobState::kSucceeded);
    EXPECT_TRUE(job.shared);
    EXPECT_FALSE(job.pinned);
    EXPECT_EQ(job.purge_ms, 9);
    EXPECT_EQ(jobs.artifacts(1, "", 10)->size(), 1U);
    EXPECT_EQ(jobs.events(1, 0, 10)->size(), 1U);
    EXPECT_EQ(JobQueue(changes).waiting()->size(), 1U);
    EXPECT_EQ(assets.asset_for("aa", {"", true})->owners, (std::vector<std::string>{"ann", "bea"}));
    EXPECT_EQ(assets.asset_for("aa", {"bea"})->media_type, "model/obj");
    EXPECT_TRUE(assets.asset_for("bb", {"", true})->owners.empty());
    EXPECT_FALSE(assets.asset_for("bb", {"ann"}));
    EXPECT_EQ(usage_of(*database, "ann")->stored_bytes, 4 + 4);
    // All assets count as used at the migration.
    EXPECT_TRUE(AssetRetention(*database, layout, kMonth_ms, system_clock_ms).purge());
    EXPECT_TRUE(select_asset(*database, "bb"));
    const auto accounts = auth::Accounts::open(*database, {}, system_clock_ms).value();
    EXPECT_EQ(accounts->users().list("", 10).size(), 2U);
    EXPECT_EQ(accounts->users().get("ann")->password, "hash");
    EXPECT_TRUE(accounts->users().get("bea")->disabled);
    EXPECT_EQ(accounts->keys().get("k")->display_name, "nightly");
    auth::AuditLog audit(*database, system_clock_ms);
    EXPECT_EQ(audit.list({})->size(), 1U);
    // The new columns and tables must exist.
    EXPECT_TRUE(retention.pin(1, true)->pinned);
    EXPECT_TRUE(retention.pin(1, false));
    EXPECT_TRUE(database->run("UPDATE jobs SET purge_ms=9 WHERE id=1"));
  }
}

TEST_F(Migration, JobsOfVersion3KeepFlagsAndTraits) {
  make_version_2();
  {
    const auto database = Database::open(layout.database(), "").value();
    for (const char* const statement : kVersion3) ASSERT_TRUE(database->run(statement));
    // Jobs 3 to 7: a running simulation, a dip that waits for its operator, a running print, a
    // running capture, and a queued simulation.
    for (const char* const row :
         {"'simulate', 3", "'dip', 2", "'print', 3", "'capture', 3", "'simulate', 1"}) {
      ASSERT_TRUE(database->run(
          std::string("INSERT INTO jobs(verb, state, uid, display_name, owner, priority, rank, "
                      "body, flags, pose, threads, digest, retry_of, use_cache, create_ms, "
                      "update_ms) VALUES (") +
          row + ", 'u', 'n', 'ann', 0, 1, '', '--dpi=300', '{}', 0, 'd', 0, 0, 7, 7)"));
    }
    ASSERT_TRUE(database->run("INSERT INTO dips VALUES (4, 'status')"));
  }
  const auto database = open_store(layout.database()).value();
  JobChanges changes(*database, {}, system_clock_ms);
  JobStore jobs(changes, layout, {});
  const auto dips = DeviceJobs(changes).open_dips().value();
  ASSERT_EQ(dips.size(), 1U);
  EXPECT_EQ(dips.front().id, 4);
  EXPECT_EQ(JobQueue(changes).computing().value(), std::vector<std::int64_t>{3});
  EXPECT_TRUE(jobs.executions()->empty());
  ASSERT_TRUE(jobs.interrupt_all(Interruption::kLoss));
  EXPECT_EQ(jobs.get(3)->state, JobState::kQueued) << "a computation is queued again";
  EXPECT_EQ(jobs.start(3, "local")->attempts, 1) << "starts are counted from version 5 on";
  ASSERT_EQ(jobs.executions()->size(), 1U);
  EXPECT_EQ(jobs.executions()->front().job, 3);
  for (const std::int64_t id : {4, 5, 6}) {
    EXPECT_EQ(jobs.get(id)->state, JobState::kInterrupted) << id;
  }
  EXPECT_NE(jobs.events(5, 0, 10)->back().message.find("may have printed this or not"),
            std::string::npos);
  const Work work = jobs.get(7)->definition.work;
  EXPECT_EQ(work.spec, "");
  EXPECT_EQ(work.flags, std::vector<std::string>{"--dpi=300"});
  EXPECT_EQ(work.pose_json, "{}");
}

TEST_F(Migration, NewStoreHasTheLatestVersion) {
  EXPECT_EQ(version_of(**open_store(layout.database())), kLatest);
}

TEST_F(Migration, LaterVersionIsRefusedAndUnchanged) {
  {
    const auto database = open_store(layout.database()).value();
    ASSERT_TRUE(database->run("UPDATE settings SET value='6' WHERE name='schema'"));
  }
  const auto refused = open_store(layout.database());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, "STORE_TOO_NEW");
  EXPECT_NE(refused.error().message.find("hydroprint.db"), std::string::npos);
  EXPECT_EQ(version_of(*Database::open(layout.database(), "").value()), "6");
}

TEST_F(Migration, FailedMigrationChangesNothing) {
  make_version_1();
  {
    const auto database = Database::open(layout.database(), "").value();
    ASSERT_TRUE(database->run("CREATE TABLE audit(in_the_way)"));
  }
  EXPECT_FALSE(open_store(layout.database()));
  const auto database = Database::open(layout.database(), "").value();
  EXPECT_EQ(version_of(*database), "1");
  EXPECT_TRUE(database->run("DROP TABLE audit"));
  EXPECT_EQ(version_of(**open_store(layout.database())), kLatest);
}

}  // namespace
}  // namespace hydroprint::daemon
