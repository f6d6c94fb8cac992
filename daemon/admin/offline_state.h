#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "daemon/platform/durable_file.h"
#include "daemon/store/database/database.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::admin {

/// A state folder that is there, seen from outside the daemon that may run on it.
struct State {
  daemon::Layout layout;
  std::unique_ptr<daemon::Database> database;
  /// Held while no daemon runs, so that none begins meanwhile; not valid while one does.
  daemon::UniqueFd lock;

  [[nodiscard]] bool daemon_runs() const { return !lock.valid(); }
};

/// Opens a state folder's store as it is: it is not brought to this version, since a daemon of
/// another one may run on it.
/// @param root  empty: the one of this user's daemon
/// @return kNotFound if there is none; kPermissionDenied if it is another user's, who alone may
///   write there; kFailedPrecondition, as open_store_as_it_is() has it, or RESTORE_UNFINISHED
[[nodiscard]] Result<State> open_state(const std::filesystem::path& root);

/// That folder's path, whole; the user's own daemon's for an empty one.
[[nodiscard]] Result<std::filesystem::path> state_root(const std::filesystem::path& root);

/// Refuses (kPermissionDenied) a folder of another user's.
[[nodiscard]] Status check_is_mine(const std::filesystem::path& folder);

/// The name, on this machine, of whoever runs this, or of who became this user by sudo.
[[nodiscard]] std::string operator_name();

/// Writes to the audit log of the store what was done from the command line.
[[nodiscard]] Status note(daemon::Database& database, const std::string& what,
                          const std::string& object);

}  // namespace hydroprint::admin
