#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::worker {

/// Returns a hash that is equal on two machines if the same worker is installed, in whatever
/// folder: the SHA-256, hex, of what `sha256sum hydroprint-*.so hydroprint-worker` prints in the
/// folder of this program, with its modules (module.h) sorted by name. Libraries of the system are
/// not included. Error: kInternal if a file cannot be read.
[[nodiscard]] Result<std::string> build_id();

}  // namespace hydroprint::worker
