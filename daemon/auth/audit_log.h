#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "daemon/platform/clock.h"
#include "daemon/store/database/database.h"
#include "sim/base/result.h"

namespace hydroprint::auth {

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

/// Who did what, for a year. A thread writes what is noted to the store, usually within
/// milliseconds; whoever notes it waits for that, or does not. If the store hangs, the first 10000
/// wait in memory, and what does not fit is counted and told of in an entry of its own. Any thread
/// may call.
class AuditLog {
 public:
  AuditLog(daemon::Database& database, daemon::Clock clock);
  /// Writes what waits.
  ~AuditLog();
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  /// Never waits.
  /// @return its number, for wait_written(); 0 if it did not fit
  std::uint64_t note(AuditEntry entry);
  /// Waits, so long at most, until what was noted is on disk.
  /// @return whether it is; else it may be written later, or be lost, which is counted
  bool wait_written(std::uint64_t noted, std::chrono::milliseconds limit);
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
  std::condition_variable settled_;
  std::vector<AuditEntry> waiting_;
  std::uint64_t noted_ = 0;    // so many came
  std::uint64_t written_ = 0;  // up to this one, all that was not lost
  std::uint64_t failed_ = 0;   // up to this one, it is known what became of them
  std::int64_t lost_ = 0;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace hydroprint::auth
