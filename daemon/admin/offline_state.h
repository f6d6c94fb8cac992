#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "daemon/platform/durable_file.h"
#include "daemon/store/database/database.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::admin {

/// An existing state folder, opened by a process other than the daemon.
struct State {
  daemon::Layout layout;
  std::unique_ptr<daemon::Database> database;
  /// The folder's lock, held if no daemon is running, so that none can start. Not valid while a
  /// daemon is running.
  daemon::UniqueFd lock;

  [[nodiscard]] bool daemon_runs() const { return !lock.valid(); }
};

/// Opens the store of a state folder, which a daemon may be using.
/// @param root  empty: the folder of this user's daemon
/// @return kNotFound if the folder does not exist; kPermissionDenied if it belongs to another user;
///         kFailedPrecondition, STORE_DIFFERS or RESTORE_UNFINISHED
[[nodiscard]] Result<State> open_state(const std::filesystem::path& root);

/// Returns the absolute path of the folder; an empty `root` means the folder of the user's own
/// daemon.
[[nodiscard]] Result<std::filesystem::path> state_root(const std::filesystem::path& root);

/// Returns kNotFound if a folder has no database, or if this user cannot read it.
[[nodiscard]] Status check_has_database(const daemon::Layout& layout);

/// Returns the name of the user who runs this process, or of the user who called sudo.
[[nodiscard]] std::string operator_name();

/// Adds a command to the audit log of the store.
[[nodiscard]] Status note(daemon::Database& database, const std::string& what,
                          const std::string& object);

}  // namespace hydroprint::admin
