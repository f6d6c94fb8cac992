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

/// One recorded action; see hydroprint.v1.AuditEntry.
struct AuditEntry {
  std::int64_t seq = 0;      ///< set when stored
  std::int64_t time_ms = 0;  ///< set when recorded
  std::string who;
  std::string via;
  std::string peer;
  std::string what;
  std::string object;
  std::string outcome;
  std::string detail;
};

/// Selects the entries to list.
struct AuditFilter {
  std::string who;          ///< empty: all
  std::string what;         ///< prefix of the method's name; empty: all
  std::int64_t before = 0;  ///< only entries with a smaller seq; 0: all
  std::int64_t limit = 50;
};

/// Keeps a record of all actions for a year. A thread writes entries to the store, usually within
/// milliseconds; callers may wait until their entry is written. If the store does not respond, up
/// to 10000 entries wait in memory. Further entries are lost; a separate entry records their
/// number. Thread-safe.
class AuditLog {
 public:
  AuditLog(daemon::Database& database, daemon::Clock clock);
  /// Writes the waiting entries, then stops.
  ~AuditLog();
  AuditLog(const AuditLog&) = delete;
  AuditLog& operator=(const AuditLog&) = delete;

  /// Records an entry without waiting.
  /// @return the entry's number, for wait_written(); 0 if memory is full
  std::uint64_t note(AuditEntry entry);
  /// Waits up to `limit` until an entry is on disk.
  /// @return whether it is on disk; if not, it may still be written later, or be lost and counted
  bool wait_written(std::uint64_t noted, std::chrono::milliseconds limit);
  /// Lists entries, newest first, including everything recorded before the call.
  [[nodiscard]] Result<std::vector<AuditEntry>> list(const AuditFilter& filter);
  /// Deletes entries older than a year, and the oldest beyond a million.
  [[nodiscard]] Status clean_up();

 private:
  void work();
  [[nodiscard]] Status write_waiting();

  daemon::Database& database_;
  daemon::Clock clock_;
  std::mutex writing_;  // serialises writes and keeps their order
  std::mutex mutex_;    // protects the members below; locked only briefly
  std::condition_variable some_;
  std::condition_variable settled_;
  std::vector<AuditEntry> waiting_;
  std::uint64_t noted_ = 0;    // number of entries recorded
  std::uint64_t written_ = 0;  // highest number in the last batch that was written
  std::uint64_t failed_ = 0;   // highest number in the last batch that could not be written
  std::int64_t lost_ = 0;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace hydroprint::auth
