#include "daemon/store/database/schema.h"

#include <string>
#include <vector>

namespace hydroprint::daemon {
namespace {

/// Statements that migrate the store from the previous version to the version `to`.
struct Migration {
  std::int64_t to;
  std::vector<const char*> statements;
};

const std::vector<Migration>& migrations() {
  static const std::vector<Migration> all{
      // Version 2: users. `role` is a number of hydroprint.v1.Role.
      {2,
       {"CREATE TABLE users(name TEXT PRIMARY KEY, role INTEGER NOT NULL, disabled INTEGER NOT "
        "NULL, "
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
        "ALTER TABLE jobs ADD COLUMN shared INTEGER NOT NULL DEFAULT 0"}},
      // Version 3: quotas and retention. The owner of a job becomes an owner of the assets that the
      // job uses. All assets count as last used at the time of the migration. Retention of a
      // finished job starts at `keep_from_ms`.
      {3,
       {"CREATE TABLE asset_owners(owner TEXT NOT NULL, "
        "sha256 TEXT NOT NULL REFERENCES assets(sha256) ON DELETE CASCADE, "
        "create_ms INTEGER NOT NULL, PRIMARY KEY(owner, sha256)) WITHOUT ROWID",
        "CREATE INDEX owners_by_asset ON asset_owners(sha256)",
        "INSERT OR IGNORE INTO asset_owners SELECT jobs.owner, assets.sha256, assets.create_ms "
        "FROM job_inputs JOIN jobs ON jobs.id=job_inputs.job JOIN assets USING(sha256)",
        "ALTER TABLE assets ADD COLUMN use_ms INTEGER NOT NULL DEFAULT 0",
        "UPDATE assets SET use_ms=1000*CAST(strftime('%s','now') AS INTEGER)",
        "ALTER TABLE uploads ADD COLUMN owner TEXT NOT NULL DEFAULT ''",
        "ALTER TABLE jobs ADD COLUMN pinned INTEGER NOT NULL DEFAULT 0",
        "ALTER TABLE jobs ADD COLUMN keep_from_ms INTEGER NOT NULL DEFAULT 0",
        "UPDATE jobs SET keep_from_ms=end_ms", "CREATE INDEX jobs_by_owner ON jobs(owner)",
        "CREATE TABLE former_users(name TEXT PRIMARY KEY, delete_ms INTEGER NOT NULL) "
        "WITHOUT ROWID"}},
      // Version 4: the spec of a job is stored as JSON; jobs stored earlier keep the worker's
      // command-line flags. Properties of a job's kind become columns of the job's row.
      {4,
       {"ALTER TABLE jobs ADD COLUMN spec TEXT NOT NULL DEFAULT ''",
        "ALTER TABLE jobs ADD COLUMN computed INTEGER NOT NULL DEFAULT 1",
        "ALTER TABLE jobs ADD COLUMN reads_artifacts INTEGER NOT NULL DEFAULT 0",
        "ALTER TABLE jobs ADD COLUMN interrupted_advice TEXT NOT NULL DEFAULT ''",
        "UPDATE jobs SET computed=0 WHERE verb IN ('dip','print','capture')",
        "UPDATE jobs SET reads_artifacts=1, interrupted_advice='the printer may have printed this "
        "or not; look before you print again' WHERE verb='print'"}},
      // Version 5: open executions of jobs; see Execution. The key lets a job have only one.
      // `jobs.attempts` is the number of times that the job was started.
      {5,
       {"ALTER TABLE jobs ADD COLUMN attempts INTEGER NOT NULL DEFAULT 0",
        "CREATE TABLE executions(job INTEGER PRIMARY KEY REFERENCES jobs(id) ON DELETE CASCADE, "
        "attempt INTEGER NOT NULL, executor TEXT NOT NULL, handle TEXT NOT NULL, "
        "folder TEXT NOT NULL)"}},
  };
  return all;
}

Result<std::int64_t> version_of(Database& database) {
  std::int64_t version = 0;
  HP_RETURN_IF_ERROR(
      database.each("SELECT CAST(value AS INTEGER) FROM settings WHERE name='schema'", {},
                    [&](const DbRow& row) { version = row.integer(0); }));
  return version;
}

tl::unexpected<Error> too_new() {
  return fail(
      Code::kFailedPrecondition,
      "was made by a later version of hydroprintd; use that version, or another state folder",
      "STORE_TOO_NEW");
}

tl::unexpected<Error> naming(const std::filesystem::path& path, Error error) {
  error.message = path.string() + ": " + error.message;
  return tl::unexpected(std::move(error));
}

Status check_version(Database& database) {
  HP_ASSIGN_OR_RETURN(const std::int64_t version, version_of(database));
  if (version > migrations().back().to) return too_new();
  if (version == migrations().back().to) return {};
  return fail(Code::kFailedPrecondition,
              "was made by an earlier version of hydroprintd; start this version once to migrate "
              "the store");
}

Status migrate(Database& database) {
  HP_ASSIGN_OR_RETURN(const std::int64_t version, version_of(database));
  if (version > migrations().back().to) return too_new();
  for (const Migration& migration : migrations()) {
    if (migration.to <= version) continue;
    for (const char* statement : migration.statements) {
      HP_RETURN_IF_ERROR(database.run(statement));
    }
    HP_RETURN_IF_ERROR(database.run("UPDATE settings SET value=? WHERE name='schema'",
                                    {std::to_string(migration.to)}));
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<Database>> open_store(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(auto database, Database::open(path, kSchema));
  if (const Status done = database->transaction([&] { return migrate(*database); }); !done) {
    return naming(path, done.error());
  }
  return database;
}

Result<std::unique_ptr<Database>> open_store_as_it_is(const std::filesystem::path& path) {
  HP_ASSIGN_OR_RETURN(auto database, Database::open(path, ""));
  if (const Status good = check_version(*database); !good) return naming(path, good.error());
  return database;
}

}  // namespace hydroprint::daemon
