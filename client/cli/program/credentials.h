#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::cli {

/// Where API keys are kept, one for each address of a daemon: a file of mode 0600,
/// $XDG_CONFIG_HOME/hydroprint/credentials.toml or ~/.config/hydroprint/credentials.toml.
[[nodiscard]] std::filesystem::path credentials_file();

/// The key for that daemon; empty if there is none.
/// @return kInvalidArgument for a file that cannot be read as TOML; kPermissionDenied for one that
///   others may read
[[nodiscard]] Result<std::string> kept_key(const std::string& server);

/// Keeps a key; the file appears at once and whole. As above; kPermissionDenied if it cannot be
/// written.
/// @param key  empty: forgets it
[[nodiscard]] Status keep_key(const std::string& server, const std::string& key);

}  // namespace hydroprint::cli
