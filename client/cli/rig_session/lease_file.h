#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "sim/base/result.h"

namespace hydroprint::cli {

/// Where the id of the lease of a daemon's rig stands between two commands: a file of mode 0600 for
/// each address, in $XDG_RUNTIME_DIR/hydroprint or else ~/.local/state/hydroprint.
[[nodiscard]] std::filesystem::path lease_file(const std::string& server);

/// Keeps an id there; the file appears at once and whole.
/// @return kPermissionDenied naming the file and what to do
[[nodiscard]] Status keep_lease(const std::string& server, const std::string& lease_id);

/// The id kept; none if there is none.
[[nodiscard]] std::optional<std::string> kept_lease(const std::string& server);

/// Removes the file if that id stands there.
void forget_lease(const std::string& server, const std::string& lease_id);

}  // namespace hydroprint::cli
