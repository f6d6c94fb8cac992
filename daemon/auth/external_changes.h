#pragma once

#include <string>

#include "daemon/auth/accounts.h"
#include "sim/base/process/periodic_thread.h"

namespace hydroprint::auth {

// A daemon knows its people by a copy in memory. Another program that changed their rows says so in
// the store, and the daemon, which looks there a few times a second, says when it has read them.

/// Asks a daemon to read its people anew. To be called after they were changed.
/// @return the word that the daemon answers with
[[nodiscard]] Result<std::string> tell_daemon(daemon::Database& database);

/// Waits up to ten seconds for that answer.
/// @return kUnavailable if there is none
[[nodiscard]] Status wait_for_daemon(daemon::Database& database, const std::string& word);

/// The daemon's side, a thread of its own.
class ExternalChanges {
 public:
  /// @param accounts  outlives it
  ExternalChanges(daemon::Database& database, Accounts& accounts);

 private:
  [[nodiscard]] Status look();

  daemon::Database& database_;
  Accounts& accounts_;
  PeriodicThread thread_;
};

}  // namespace hydroprint::auth
