#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/files/files.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// A file that a job produced.
struct Artifact {
  std::string name;  ///< "jobs/7/artifacts/film.png"
  std::int64_t size_bytes = 0;
  std::string sha256;
  std::string media_type;

  [[nodiscard]] std::string file_name() const;  ///< "film.png"
};

/// Returns all artifacts of a job, sorted by name; empty until the job has succeeded.
[[nodiscard]] Result<std::vector<Artifact>> list_artifacts(Connection& connection,
                                                           const std::string& job);

/// Downloads an artifact into `folder` (created if missing) under its file name. The bytes go into
/// a hidden file beside it, from which a later attempt resumes. The final file appears only when it
/// is complete and its SHA-256 matches. An existing file with the same bytes is kept; one with
/// other bytes is replaced.
/// @return the file's path; kDataLoss if the bytes are not what the daemon announced
[[nodiscard]] Result<std::filesystem::path> download(Connection& connection,
                                                     const Artifact& artifact,
                                                     const std::filesystem::path& folder,
                                                     const ByteProgress& progress = {});

}  // namespace hydroprint::client
