#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/files/files.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// A file that a job made.
struct Artifact {
  std::string name;  ///< "jobs/7/artifacts/film.png"
  std::int64_t size_bytes = 0;
  std::string sha256;
  std::string media_type;

  [[nodiscard]] std::string file_name() const;  ///< "film.png"
};

/// Every artifact of a job, by name; none before it succeeded.
[[nodiscard]] Result<std::vector<Artifact>> list_artifacts(Connection& connection,
                                                           const std::string& job);

/// Downloads an artifact into `folder` (made if it does not exist) under its file name. The file
/// appears at once, complete and with the right SHA-256; until then its bytes are in a hidden file
/// beside it, from which another attempt goes on. A file that is there with the right bytes stays
/// as it is, one with other bytes is replaced.
/// @return the file's path; kDataLoss if the bytes are not what the daemon announced
[[nodiscard]] Result<std::filesystem::path> download(Connection& connection,
                                                     const Artifact& artifact,
                                                     const std::filesystem::path& folder,
                                                     const ByteProgress& progress = {});

}  // namespace hydroprint::client
