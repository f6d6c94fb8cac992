#include "daemon/store/database/schema.h"

#include <fmt/format.h>

#include <fstream>

#include "daemon/platform/durable_file.h"

namespace hydroprint::daemon {
namespace {

using namespace std::string_literals;

constexpr std::uintmax_t kLargeDatabase = 256 << 20;

/// The store's tables. If they change, raise user_version here and in check_build(), which reads it
/// and application_id from the header of the file. `jobs.body`, `dips.status` and
/// `calibrations.body` are serialised messages. `jobs.attempts` is the number of times that the job
/// was started; its retention starts at `keep_from_ms`. `executions` are the open executions of
/// jobs. `losses.count` is the number of times that the daemon was killed, or its machine crashed,
/// while the job ran. `lease` has at most one row. `calibrations.job` is 0 for a manual entry.
/// `captures` outlive their jobs, because calibrations do. `role` is a number of
/// hydroprint.v1.Role.
constexpr const char* kSchema = R"sql(
PRAGMA application_id=0x48795072;
PRAGMA user_version=1;
CREATE TABLE settings(name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE jobs(
  id INTEGER PRIMARY KEY AUTOINCREMENT, uid TEXT NOT NULL, display_name TEXT NOT NULL,
  owner TEXT NOT NULL, priority INTEGER NOT NULL, rank INTEGER NOT NULL, body BLOB NOT NULL,
  verb TEXT NOT NULL, spec TEXT NOT NULL, computed INTEGER NOT NULL,
  reads_artifacts INTEGER NOT NULL, interrupted_advice TEXT NOT NULL,
  threads INTEGER NOT NULL, digest TEXT NOT NULL, retry_of INTEGER NOT NULL,
  use_cache INTEGER NOT NULL, cache_hit INTEGER NOT NULL DEFAULT 0,
  state INTEGER NOT NULL, fraction REAL NOT NULL DEFAULT 0, phase TEXT NOT NULL DEFAULT '',
  phase_fraction REAL NOT NULL DEFAULT 0, eta_ms INTEGER NOT NULL DEFAULT 0,
  create_ms INTEGER NOT NULL, start_ms INTEGER NOT NULL DEFAULT 0, end_ms INTEGER NOT NULL DEFAULT 0,
  update_ms INTEGER NOT NULL, keep_from_ms INTEGER NOT NULL DEFAULT 0,
  purge_ms INTEGER NOT NULL DEFAULT 0, version INTEGER NOT NULL DEFAULT 1,
  waits_for TEXT NOT NULL DEFAULT '',
  error_code INTEGER, error_reason TEXT, error_message TEXT, error_field TEXT,
  exit_status INTEGER, signal INTEGER,
  shared INTEGER NOT NULL DEFAULT 0, pinned INTEGER NOT NULL DEFAULT 0,
  attempts INTEGER NOT NULL DEFAULT 0);
CREATE INDEX jobs_by_state ON jobs(state);
CREATE INDEX jobs_by_digest ON jobs(digest);
CREATE INDEX jobs_by_owner ON jobs(owner);
CREATE TABLE job_inputs(
  job INTEGER NOT NULL REFERENCES jobs(id) ON DELETE CASCADE, name TEXT NOT NULL,
  sha256 TEXT NOT NULL, PRIMARY KEY(job, name)) WITHOUT ROWID;
CREATE INDEX inputs_by_hash ON job_inputs(sha256);
CREATE TABLE events(
  seq INTEGER PRIMARY KEY AUTOINCREMENT,
  job INTEGER NOT NULL REFERENCES jobs(id) ON DELETE CASCADE, time_ms INTEGER NOT NULL,
  kind INTEGER NOT NULL, state INTEGER NOT NULL, fraction REAL NOT NULL, phase TEXT NOT NULL,
  phase_fraction REAL NOT NULL, eta_ms INTEGER NOT NULL, message TEXT NOT NULL,
  waits_for TEXT NOT NULL DEFAULT '');
CREATE INDEX events_by_job ON events(job, seq);
CREATE TABLE executions(
  job INTEGER PRIMARY KEY REFERENCES jobs(id) ON DELETE CASCADE, attempt INTEGER NOT NULL,
  executor TEXT NOT NULL, handle TEXT NOT NULL, folder TEXT NOT NULL);
CREATE TABLE artifacts(
  job INTEGER NOT NULL REFERENCES jobs(id) ON DELETE CASCADE, name TEXT NOT NULL,
  size INTEGER NOT NULL, sha256 TEXT NOT NULL, media_type TEXT NOT NULL,
  PRIMARY KEY(job, name)) WITHOUT ROWID;
CREATE TABLE assets(
  sha256 TEXT PRIMARY KEY, size INTEGER NOT NULL, media_type TEXT NOT NULL,
  create_ms INTEGER NOT NULL, use_ms INTEGER NOT NULL DEFAULT 0) WITHOUT ROWID;
CREATE TABLE asset_owners(
  owner TEXT NOT NULL, sha256 TEXT NOT NULL REFERENCES assets(sha256) ON DELETE CASCADE,
  create_ms INTEGER NOT NULL, PRIMARY KEY(owner, sha256)) WITHOUT ROWID;
CREATE INDEX owners_by_asset ON asset_owners(sha256);
CREATE TABLE uploads(
  id TEXT PRIMARY KEY, sha256 TEXT NOT NULL, size INTEGER NOT NULL, media_type TEXT NOT NULL,
  expire_ms INTEGER NOT NULL, owner TEXT NOT NULL DEFAULT '') WITHOUT ROWID;
CREATE TABLE losses(
  job INTEGER PRIMARY KEY REFERENCES jobs(id) ON DELETE CASCADE, count INTEGER NOT NULL);
CREATE TABLE dips(
  job INTEGER PRIMARY KEY REFERENCES jobs(id) ON DELETE CASCADE, status BLOB NOT NULL);
CREATE TABLE lease(
  one INTEGER PRIMARY KEY CHECK(one=1), id TEXT NOT NULL, holder TEXT NOT NULL,
  purpose TEXT NOT NULL, acquire_ms INTEGER NOT NULL, expire_ms INTEGER NOT NULL);
CREATE TABLE calibrations(
  id INTEGER PRIMARY KEY AUTOINCREMENT, kind INTEGER NOT NULL, owner TEXT NOT NULL,
  job INTEGER NOT NULL, capture INTEGER NOT NULL, active INTEGER NOT NULL,
  create_ms INTEGER NOT NULL, body BLOB NOT NULL);
CREATE INDEX calibrations_by_job ON calibrations(job);
CREATE TABLE captures(
  job INTEGER PRIMARY KEY, time_ms INTEGER NOT NULL, watched INTEGER NOT NULL,
  homed INTEGER NOT NULL, axis_mm REAL NOT NULL, homings INTEGER NOT NULL, dips INTEGER NOT NULL);
CREATE TABLE requests(
  owner TEXT NOT NULL, method TEXT NOT NULL, id TEXT NOT NULL, digest TEXT NOT NULL,
  result TEXT NOT NULL, time_ms INTEGER NOT NULL, PRIMARY KEY(owner, method, id)) WITHOUT ROWID;
CREATE TABLE users(
  name TEXT PRIMARY KEY, role INTEGER NOT NULL, disabled INTEGER NOT NULL,
  password TEXT NOT NULL, create_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE former_users(name TEXT PRIMARY KEY, delete_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE api_keys(
  id TEXT PRIMARY KEY, user TEXT NOT NULL REFERENCES users(name) ON DELETE CASCADE,
  display_name TEXT NOT NULL, secret_hash TEXT NOT NULL, role INTEGER NOT NULL,
  create_ms INTEGER NOT NULL, expire_ms INTEGER NOT NULL, use_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE sessions(
  id TEXT PRIMARY KEY, user TEXT NOT NULL REFERENCES users(name) ON DELETE CASCADE,
  token_hash TEXT NOT NULL UNIQUE, peer TEXT NOT NULL, create_ms INTEGER NOT NULL,
  use_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE sign_in_links(
  token_hash TEXT PRIMARY KEY, user TEXT NOT NULL REFERENCES users(name) ON DELETE CASCADE,
  expire_ms INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE audit(
  seq INTEGER PRIMARY KEY AUTOINCREMENT, time_ms INTEGER NOT NULL, who TEXT NOT NULL,
  via TEXT NOT NULL, peer TEXT NOT NULL, what TEXT NOT NULL, object TEXT NOT NULL,
  outcome TEXT NOT NULL, detail TEXT NOT NULL);
CREATE INDEX audit_by_time ON audit(time_ms);
)sql";

/// The bytes of all artifacts of each owner, and of those of pinned jobs: each new job is checked
/// against a quota of them, and to add them up takes long for an owner with many jobs. The table is
/// only in the memory of this connection. Deleting a job also deletes its artifacts, and no
/// statement deletes artifacts alone.
constexpr const char* kUsage = R"sql(
CREATE TEMP TABLE artifact_bytes(
  owner TEXT PRIMARY KEY, bytes INTEGER NOT NULL, pinned INTEGER NOT NULL) WITHOUT ROWID;
INSERT INTO artifact_bytes SELECT owner, sum(size), sum(size*pinned) FROM jobs JOIN artifacts
  ON artifacts.job=jobs.id GROUP BY owner;
CREATE TEMP TRIGGER artifact_added AFTER INSERT ON main.artifacts BEGIN
  INSERT INTO artifact_bytes SELECT owner, new.size, new.size*pinned FROM jobs WHERE id=new.job
    ON CONFLICT(owner) DO UPDATE SET bytes=bytes+excluded.bytes, pinned=pinned+excluded.pinned;
END;
CREATE TEMP TRIGGER job_pinned AFTER UPDATE OF pinned ON main.jobs BEGIN
  UPDATE artifact_bytes SET pinned=pinned+(new.pinned-old.pinned)*
    (SELECT coalesce(sum(size),0) FROM artifacts WHERE job=new.id) WHERE owner=new.owner;
END;
CREATE TEMP TRIGGER job_deleted BEFORE DELETE ON main.jobs BEGIN
  UPDATE artifact_bytes SET (bytes, pinned)=
    (SELECT bytes-coalesce(sum(size),0), pinned-old.pinned*coalesce(sum(size),0) FROM artifacts
     WHERE job=old.id) WHERE owner=old.owner;
END;
)sql";

/// Creates a complete store, or nothing. SQLite would apply the log of a lost database to it.
Status create(const std::filesystem::path& path) {
  const std::string part = path.string() + ".part";
  for (const char* const tail : {".part", "-wal", "-shm"}) discard(path.string() + tail);
  HP_ASSIGN_OR_RETURN(const auto memory, Database::open(":memory:", kSchema));
  HP_RETURN_IF_ERROR(memory->run("VACUUM INTO ?", {part}));
  return publish(part, path);
}

/// Returns whether a database is checked when it is opened: always, or if it is large, only if the
/// last daemon was killed. SQLite deletes the log when the last connection is closed.
bool needs_check(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto log_bytes = std::filesystem::file_size(path.string() + "-wal", ignored);
  const bool was_killed = !ignored && log_bytes > 0;
  return was_killed || std::filesystem::file_size(path, ignored) < kLargeDatabase;
}

}  // namespace

Status check_build(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  std::string header(72, '\0');
  file.read(header.data(), 72);
  // Offsets from https://www.sqlite.org/fileformat.html; the numbers are big-endian.
  if (header.substr(60, 4) == "\0\0\0\1"s && header.substr(68) == "HyPr") return {};
  return fail(
      Code::kFailedPrecondition,
      fmt::format("{}: was made by another build of hydroprint, or its beginning is damaged; "
                  "use that build, or set the state folder aside (rename {}) and start with "
                  "an empty one; hydroprint admin set-aside sets only the database aside",
                  path.string(), path.parent_path().string()),
      ErrorReason::STORE_DIFFERS);
}

Result<std::unique_ptr<Database>> open_store(const std::filesystem::path& path) {
  HP_RETURN_IF_ERROR(check_build(path));
  std::error_code error;
  if (!std::filesystem::exists(path, error) && !error) {
    HP_RETURN_IF_ERROR(create(path));
  } else if (needs_check(path)) {
    HP_RETURN_IF_ERROR(Database::check(path));
  }
  return Database::open(path, kUsage);
}

}  // namespace hydroprint::daemon
