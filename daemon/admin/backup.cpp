#include "daemon/admin/backup.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "daemon/admin/archive.h"
#include "daemon/admin/progress_meter.h"
#include "daemon/platform/clock.h"

namespace hydroprint::admin {
namespace {

using daemon::DbRow;

/// A snapshot of the database in a temporary file, deleted with this object.
struct Snapshot {
  ~Snapshot() {
    database.reset();
    for (const char* const tail : {"", "-wal", "-shm", "-journal"}) {
      daemon::discard(path.string() + tail);
    }
  }
  std::filesystem::path path;
  std::unique_ptr<daemon::Database> database;
};

// Removes rows that are valid only for the running daemon. Otherwise a restore could revive a
// session that ended after the backup.
Status leave_out_what_passes(daemon::Database& snapshot) {
  for (const char* const table : {"uploads", "sessions", "sign_in_links", "lease"}) {
    HP_RETURN_IF_ERROR(snapshot.run(std::string("DELETE FROM ") + table));
  }
  return snapshot.run("DELETE FROM settings WHERE name IN ('people_changed', 'people_read')");
}

// Removes from the snapshot a file that cannot be read; removes its whole job if the job has been
// deleted meanwhile.
Status forget(daemon::Database& snapshot, const NamedFile& file, bool is_deleted) {
  if (file.job == 0) return snapshot.run("DELETE FROM assets WHERE sha256=?", {file.sha256});
  if (is_deleted) return snapshot.run("DELETE FROM jobs WHERE id=?", {file.job});
  return snapshot.run("DELETE FROM artifacts WHERE job=? AND 'artifacts/' || job || '/' || name=?",
                      {file.job, file.name});
}

/// One backup in progress.
class Backup {
 public:
  Backup(State& state, Snapshot& snapshot, ArchiveWriter& out)
      : state_(state), snapshot_(snapshot), out_(out) {}

  Result<Contents> run() {
    HP_ASSIGN_OR_RETURN(const auto files, named_files(*snapshot_.database));
    std::int64_t total = 0;
    for (const NamedFile& file : files) total += file.size;
    HP_RETURN_IF_ERROR(daemon::check_free_space(snapshot_.path.parent_path(), total));
    ProgressMeter meter("backup", total);
    for (const NamedFile& file : files) {
      HP_ASSIGN_OR_RETURN(const bool is_in, take(file, meter));
      if (!is_in) {
        HP_RETURN_IF_ERROR(leave_out(file));
        continue;
      }
      ++contents_.files;
      contents_.bytes += file.size;
    }
    HP_RETURN_IF_ERROR(take_database());
    return contents_;
  }

 private:
  // Adds a file; returns false if it cannot be read or its content is wrong.
  Result<bool> take(const NamedFile& file, ProgressMeter& meter) {
    const auto in = daemon::open_file(state_.layout.root / file.name, O_RDONLY);
    if (!in) return false;
    const auto hash =
        out_.add(file.name, *in, file.size, [&](std::int64_t bytes) { meter.add(bytes); });
    if (hash) return *hash == file.sha256;
    if (hash.error().code != Code::kDataLoss) return tl::unexpected(hash.error());
    return false;
  }

  Status leave_out(const NamedFile& file) {
    HP_ASSIGN_OR_RETURN(const bool is_still_named, is_named(*state_.database, file));
    if (is_still_named) {
      contents_.warnings.push_back(file.name +
                                   " is missing or damaged, so it is not in the backup");
    }
    return forget(*snapshot_.database, file, !is_still_named);
  }

  Status take_database() {
    HP_ASSIGN_OR_RETURN(contents_.jobs, count_jobs(*snapshot_.database));
    snapshot_.database.reset();  // flushes the database to its file
    HP_ASSIGN_OR_RETURN(const auto in, daemon::open_file(snapshot_.path, O_RDONLY));
    const auto size = static_cast<std::int64_t>(std::filesystem::file_size(snapshot_.path));
    HP_ASSIGN_OR_RETURN(const std::string hash,
                        out_.add(kDatabaseName, in, size, [](std::int64_t) {}));
    const nlohmann::json manifest{
        {"format", kBackupFormat},  {"time_ms", daemon::system_clock_ms()},
        {"jobs", contents_.jobs},   {"files", contents_.files},
        {"bytes", contents_.bytes}, {"database_sha256", hash}};
    return out_.add(kManifestName, manifest.dump(2) + "\n");
  }

  State& state_;
  Snapshot& snapshot_;
  ArchiveWriter& out_;
  Contents contents_;
};

}  // namespace

Result<std::vector<NamedFile>> named_files(daemon::Database& database) {
  std::vector<NamedFile> files;
  HP_RETURN_IF_ERROR(
      database.each("SELECT sha256, size FROM assets ORDER BY sha256", {}, [&](const DbRow& row) {
        const std::string hash = row.text(0);
        files.push_back({fmt::format("assets/{}/{}", hash.substr(0, 2),
                                     hash.substr(std::min<std::size_t>(2, hash.size()))),
                         row.integer(1), hash, 0});
      }));
  HP_RETURN_IF_ERROR(
      database.each("SELECT job, name, size, sha256 FROM artifacts ORDER BY job, name", {},
                    [&](const DbRow& row) {
                      files.push_back({fmt::format("artifacts/{}/{}", row.integer(0), row.text(1)),
                                       row.integer(2), row.text(3), row.integer(0)});
                    }));
  return files;
}

Result<bool> is_named(daemon::Database& database, const NamedFile& file) {
  bool is_there = false;
  HP_RETURN_IF_ERROR(database.each(
      file.job == 0 ? "SELECT 1 FROM assets WHERE sha256=?1" : "SELECT 1 FROM jobs WHERE id=?2",
      {file.sha256, file.job}, [&](const DbRow&) { is_there = true; }));
  return is_there;
}

Result<std::int64_t> count_jobs(daemon::Database& database) {
  std::int64_t jobs = 0;
  HP_RETURN_IF_ERROR(database.each("SELECT count(*) FROM jobs", {},
                                   [&](const DbRow& row) { jobs = row.integer(0); }));
  return jobs;
}

Result<Contents> backup(State& state, const std::filesystem::path& file) {
  const auto path = std::filesystem::absolute(file).lexically_normal();
  HP_ASSIGN_OR_RETURN(const auto out, ArchiveWriter::create(path));
  Snapshot snapshot;
  snapshot.path = path.string() + ".part.db";
  daemon::discard(snapshot.path);
  HP_RETURN_IF_ERROR(state.database->run("VACUUM INTO ?", {snapshot.path.string()}));
  HP_ASSIGN_OR_RETURN(snapshot.database, daemon::Database::open(snapshot.path, ""));
  HP_RETURN_IF_ERROR(leave_out_what_passes(*snapshot.database));
  HP_ASSIGN_OR_RETURN(Contents contents, Backup(state, snapshot, *out).run());
  HP_RETURN_IF_ERROR(out->finish());
  HP_RETURN_IF_ERROR(note(*state.database, "backup", ""));
  return contents;
}

}  // namespace hydroprint::admin
