#pragma once

#include <string>

#include "daemon/auth/accounts.h"
#include "sim/base/process/periodic_thread.h"

namespace hydroprint::auth {

// A daemon keeps users in memory. Another program that changes their rows leaves a note in the
// store; the daemon checks for it a few times a second and confirms once it has read the rows.

/// Asks a running daemon to read users again. Call this after changing them.
/// @return the word with which the daemon confirms
[[nodiscard]] Result<std::string> tell_daemon(daemon::Database& database);

/// Waits up to ten seconds for the confirmation.
/// @return kUnavailable if there is none
[[nodiscard]] Status wait_for_daemon(daemon::Database& database, const std::string& word);

/// The daemon's side, with its own thread.
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
