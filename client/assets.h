#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "client/connection.h"
#include "client/files.h"
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

/// Every asset, in the order of the hashes.
[[nodiscard]] Result<std::vector<Asset>> list_assets(Connection& connection);

/// Deletes an asset that no unfinished job needs.
[[nodiscard]] Status delete_asset(Connection& connection, const std::string& name);

}  // namespace hydroprint::client
