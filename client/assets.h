#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/files/files.h"
#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Bytes that the daemon keeps, by what they contain.
struct Asset {
  std::string name;  ///< "assets/{sha256}"
  std::string sha256;
  std::int64_t size_bytes = 0;
  std::string media_type;
  std::optional<Time> create_time;
  std::vector<std::string> owners;  ///< to operators; to others at most themselves
};

/// What an upload came to.
struct Uploaded {
  Asset asset;
  bool was_known = false;  ///< the daemon had the bytes already; none were sent
};

/// Uploads a file, unless its bytes are there already. A broken connection is taken up again at the
/// byte where it broke.
/// @return errors of reading the file (files.h) or the daemon's, naming the file; kCancelled
[[nodiscard]] Result<Uploaded> upload_file(Connection& connection,
                                           const std::filesystem::path& path,
                                           const ByteProgress& progress = {});

/// The caller's assets, in the order of the hashes; as an operator everybody's.
[[nodiscard]] Result<std::vector<Asset>> list_assets(Connection& connection);

/// Gives up an asset of the caller's; as an operator deletes it, if no unfinished job needs it.
[[nodiscard]] Status delete_asset(Connection& connection, const std::string& name);

}  // namespace hydroprint::client
