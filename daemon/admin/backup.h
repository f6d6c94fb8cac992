#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "daemon/admin/offline_state.h"

namespace hydroprint::admin {

/// What a backup, or a restored one, holds.
struct Contents {
  std::int64_t jobs = 0, files = 0, bytes = 0;
  std::vector<std::string> warnings;  ///< what is not in it, since it was damaged
};

/// Writes all of a state folder to one tar archive, as it was at one moment, while the daemon goes
/// on: a snapshot of the database, and the assets and artifacts that it names. Left out: open
/// uploads, records of dips under way, sessions, links and the lease. Shows its progress on stderr.
/// @return kAlreadyExists if the file is there; kResourceExhausted, DISK_FULL; nothing is left then
[[nodiscard]] Result<Contents> backup(State& state, const std::filesystem::path& file);

// The archive: assets/aa/..., artifacts/7/..., then the database, then what shows that it is whole.
inline constexpr const char* kDatabaseName = "hydroprint.db";
inline constexpr const char* kManifestName = "backup.json";
inline constexpr int kBackupFormat = 1;

/// A file that a database names: where it is in an archive and in a state folder, and what it
/// holds.
struct NamedFile {
  std::string name;  ///< "artifacts/7/film.png"
  std::int64_t size = 0;
  std::string sha256;
  std::int64_t job = 0;  ///< 0: an asset
};
[[nodiscard]] Result<std::vector<NamedFile>> named_files(daemon::Database& database);

/// How many jobs there are.
[[nodiscard]] Result<std::int64_t> count_jobs(daemon::Database& database);

}  // namespace hydroprint::admin
