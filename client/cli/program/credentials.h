#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::cli {

/// Returns the path of the file that stores API keys, one for each daemon address:
/// $XDG_CONFIG_HOME/hydroprint/credentials.toml or ~/.config/hydroprint/credentials.toml, mode
/// 0600.
[[nodiscard]] std::filesystem::path credentials_file();

/// Returns the stored key for a daemon; empty if there is none.
/// @return kInvalidArgument if the file is not valid TOML; kPermissionDenied if other users can
///   read it
[[nodiscard]] Result<std::string> kept_key(const std::string& server);

/// Stores a key; the file is written atomically. Errors: as above, and kPermissionDenied if it
/// cannot be written.
/// @param key  empty: deletes the stored key
[[nodiscard]] Status keep_key(const std::string& server, const std::string& key);

}  // namespace hydroprint::cli
