#pragma once

#include <filesystem>
#include <memory>

#include "daemon/store/database/database.h"

namespace hydroprint::daemon {

/// Opens or creates the store, and migrates a store of an earlier version in one transaction.
/// @return errors of Database::open(); kFailedPrecondition, STORE_TOO_NEW for a store of a later
/// version
[[nodiscard]] Result<std::unique_ptr<Database>> open_store(const std::filesystem::path& path);

/// Opens a store of this version without changing it, for programs that run beside the daemon.
/// @return kFailedPrecondition: STORE_TOO_NEW for a store of a later version, without a reason code
///         for one of an earlier version
[[nodiscard]] Result<std::unique_ptr<Database>> open_store_as_it_is(
    const std::filesystem::path& path);

/// Tables of the store in version 1; schema.cpp has the later changes. `jobs.flags` has one flag
/// per line; `jobs.body`, `dips.status` and `calibrations.body` are serialised messages.
/// `losses.count` is the number of times that the daemon was killed, or its machine crashed, while
/// the job ran. `lease` has at most one row. `calibrations.job` is 0 for a manual entry. `captures`
/// outlive their jobs, because calibrations do.
inline constexpr const char* kSchema = R"sql(
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

}  // namespace hydroprint::daemon
