#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// A stored file with verified content.
struct Asset {
  std::string sha256;
  std::int64_t size_bytes = 0;
  std::string media_type;
  std::int64_t create_ms = 0;
  std::vector<std::string> owners = {};  ///< names of the users who own it
};

/// A file whose bytes are still being received.
struct Upload {
  std::string id;
  std::string sha256;
  std::int64_t size_bytes = 0;
  std::int64_t received_bytes = 0;
  std::string media_type;
  std::int64_t expire_ms = 0;
  std::string owner = {};
};

/// The result of an upload so far: the asset if all bytes are stored, otherwise the open upload.
using AssetOrUpload = std::variant<Asset, Upload>;

/// Returns the error (kFailedPrecondition, ASSET_MISSING) for a missing input file.
[[nodiscard]] tl::unexpected<Error> asset_missing(const InputFile& input);

/// Returns the error (kDataLoss, ARTIFACT_DAMAGED) for an input file whose content has changed on
/// disk.
[[nodiscard]] tl::unexpected<Error> asset_damaged(const InputFile& input);

}  // namespace hydroprint::daemon
