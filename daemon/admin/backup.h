#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/admin/offline_state.h"

namespace hydroprint::admin {

/// Summary of the content of a backup or of a restored state folder.
struct Contents {
  std::int64_t jobs = 0, files = 0, bytes = 0;
  std::vector<std::string> warnings;  ///< damaged files that were skipped
};

/// Writes a state folder to one tar archive while the daemon keeps running: a snapshot of the
/// database, and the assets and artifacts that it refers to. Skips open uploads, records of dips in
/// progress, sessions, sign-in links and the lease. Shows its progress on stderr. An error leaves
/// no file behind.
/// @return kAlreadyExists if the file exists; kResourceExhausted, DISK_FULL
[[nodiscard]] Result<Contents> backup(State& state, const std::filesystem::path& file);

// Order in the archive: assets/aa/..., artifacts/7/..., the database, and the manifest, which
// proves that the archive is complete.
inline constexpr const char* kDatabaseName = "hydroprint.db";
inline constexpr const char* kManifestName = "backup.json";
inline constexpr int kBackupFormat = 1;

/// A file that a database refers to: its path in an archive and in a state folder, and its content.
struct NamedFile {
  std::string name;  ///< "artifacts/7/film.png"
  std::int64_t size = 0;
  std::string sha256;
  std::int64_t job = 0;  ///< id of the job that has the artifact; 0: an asset
};
[[nodiscard]] Result<std::vector<NamedFile>> named_files(daemon::Database& database);

/// Returns whether a database still refers to a file.
[[nodiscard]] Result<bool> is_named(daemon::Database& database, const NamedFile& file);

/// Returns the number of jobs.
[[nodiscard]] Result<std::int64_t> count_jobs(daemon::Database& database);

}  // namespace hydroprint::admin
