#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::cli {

/// Returns the path of the file that stores the lease id between commands: one file for each
/// address, mode 0600, in $XDG_RUNTIME_DIR/hydroprint, $XDG_STATE_HOME/hydroprint or
/// ~/.local/state/hydroprint.
[[nodiscard]] std::filesystem::path lease_file(const std::string& server);

/// Stores a lease id; the file is written atomically.
/// @return kPermissionDenied naming the file and the remedy
[[nodiscard]] Status keep_lease(const std::string& server, const std::string& lease_id);

/// Returns the stored id; nullopt if there is none.
[[nodiscard]] std::optional<std::string> kept_lease(const std::string& server);

/// Removes the file if it contains that id.
void forget_lease(const std::string& server, const std::string& lease_id);

}  // namespace hydroprint::cli
