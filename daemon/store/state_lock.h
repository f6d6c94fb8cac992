#pragma once

#include <sys/types.h>

#include <filesystem>
#include <vector>

#include "daemon/platform/durable_file.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Locks the state folder (created if needed) for this process, until the descriptor is closed.
/// @return kFailedPrecondition if another daemon uses the folder; kPermissionDenied if it belongs
/// to
///         another user
[[nodiscard]] Result<UniqueFd> lock_state(const Layout& layout);

/// A file or folder of the state folder, and the mode that keeps other users of the machine out.
struct PrivatePath {
  std::filesystem::path path;
  mode_t mode = 0700;
};

/// Returns those of the database's files and the folders that exist. The folders protect the files
/// in them.
[[nodiscard]] std::vector<PrivatePath> private_paths(const Layout& layout);

/// Corrects the modes of private_paths(), and logs a warning for each that was different. Call this
/// before the database is opened.
/// @return kPermissionDenied if one belongs to another user; the errors of set_mode()
[[nodiscard]] Status correct_modes(const Layout& layout);

/// Returns kFailedPrecondition, RESTORE_UNFINISHED for a folder with an unfinished restore.
[[nodiscard]] Status check_restored(const Layout& layout);

}  // namespace hydroprint::daemon
