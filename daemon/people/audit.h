#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "daemon/clock.h"
#include "daemon/database.h"
#include "sim/base/result.h"

namespace hydroprint::people {

/// Something that was done; see hydroprint.v1.AuditEntry.
struct AuditEntry {
  std::int64_t seq = 0;      ///< set when it is stored
  std::int64_t time_ms = 0;  ///< set when it is noted
  std::string who;
  std::string via;
  std::string peer;
  std::string what;
  std::string object;
  std::string outcome;
  std::string detail;
};

/// Which entries are listed.
struct AuditFilter {
  std::string who;          ///< empty: all
  std::string what;         ///< beginning of the method's name; empty: all
  std::int64_t before = 0;  ///< only those with a smaller seq; 0: all
  std::int64_t limit = 50;
};

/// Who did what, for a year. Whoever notes something never waits: a thread writes it to the store,
/// usually within milliseconds. If the store hangs, the latest 10000 wait in memory, and what does
/// not fit is counted and told of in an entry of its own. Any thread may call.
class AuditLog {
 public:
  AuditLog(daemon::Database& database, daemon::Clock clock);
  /// Writes what waits.
  ~AuditLog();
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  void note(AuditEntry entry);
  /// Newest first, with all that was noted before the call.
  [[nodiscard]] Result<std::vector<AuditEntry>> list(const AuditFilter& filter);
  /// Deletes what is older than a year, and the oldest of more than a million.
  [[nodiscard]] Status clean_up();

 private:
  void work();
  [[nodiscard]] Status write_waiting();

  daemon::Database& database_;
  daemon::Clock clock_;
  std::mutex writing_;  // one writes at a time, in order
  std::mutex mutex_;    // of what follows; held for moments only
  std::condition_variable some_;
  std::vector<AuditEntry> waiting_;
  std::int64_t lost_ = 0;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace hydroprint::people
