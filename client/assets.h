#pragma once

#include <filesystem>
#include <string>

#include "client/connection/connection.h"
#include "client/files/files.h"
#include "hydroprint/v1/asset_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// The result of an upload.
struct Uploaded {
  v1::Asset asset;
  bool was_known = false;  ///< the daemon already had the bytes; none were sent
};

/// Uploads a file unless the daemon already has its bytes. After a lost connection, the upload
/// resumes at the last byte received.
/// @return errors of reading the file (files.h) or of the daemon, naming the file; kCancelled
[[nodiscard]] Result<Uploaded> upload_file(Connection& connection,
                                           const std::filesystem::path& path,
                                           const ByteProgress& progress = {});

/// Lists the caller's assets, sorted by hash; for an operator, the assets of all users.
[[nodiscard]] Result<v1::ListAssetsResponse> list_assets(Connection& connection);

/// Removes the caller from an asset's owners. For an operator, deletes the asset unless an
/// unfinished job needs it.
[[nodiscard]] Status delete_asset(Connection& connection, const std::string& name);

}  // namespace hydroprint::client
