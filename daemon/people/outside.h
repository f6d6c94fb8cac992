#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/people/accounts.h"

namespace hydroprint::people {

// A daemon knows its people by a copy in memory. Another program that changed their rows says so in
// the store, and the daemon, which looks there a few times a second, says when it has read them.

/// Asks a daemon to read its people anew. To be called after they were changed.
/// @return the word that the daemon answers with
[[nodiscard]] Result<std::string> tell_daemon(daemon::Database& database);

/// Waits up to ten seconds for that answer.
/// @return kUnavailable if there is none
[[nodiscard]] Status wait_for_daemon(daemon::Database& database, const std::string& word);

/// The daemon's side, a thread of its own.
class OutsideChanges {
 public:
  /// @param accounts  outlives it
  OutsideChanges(daemon::Database& database, Accounts& accounts);
  ~OutsideChanges();
  OutsideChanges(const OutsideChanges&) = delete;
  OutsideChanges& operator=(const OutsideChanges&) = delete;

 private:
  void work();
  [[nodiscard]] Status look();

  daemon::Database& database_;
  Accounts& accounts_;
  std::mutex mutex_;
  std::condition_variable end_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace hydroprint::people
