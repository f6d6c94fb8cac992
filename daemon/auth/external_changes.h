#pragma once

#include <string>

#include "daemon/auth/accounts.h"
#include "sim/base/process/periodic_thread.h"

namespace hydroprint::auth {

// The daemon keeps users in memory. A program that changes their rows sets a marker in the store.
// The daemon polls for the marker several times a second, reloads the rows, and confirms this in
// the store.

/// Requests a running daemon to reload users. Call this after changing them.
/// @return the token with which the daemon confirms
[[nodiscard]] Result<std::string> tell_daemon(daemon::Database& database);

/// Waits up to ten seconds until the daemon has confirmed the token `word`.
/// @return kUnavailable if the daemon does not confirm in time
[[nodiscard]] Status wait_for_daemon(daemon::Database& database, const std::string& word);

/// The daemon's side: polls for the marker in its own thread.
class ExternalChanges {
 public:
  /// @param accounts  must outlive this object
  ExternalChanges(daemon::Database& database, Accounts& accounts);

 private:
  [[nodiscard]] Status look();

  daemon::Database& database_;
  Accounts& accounts_;
  PeriodicThread thread_;
};

}  // namespace hydroprint::auth
