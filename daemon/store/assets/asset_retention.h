#pragma once

#include <cstdint>

#include "daemon/platform/clock.h"
#include "daemon/store/database/database.h"
#include "daemon/store/state_layout.h"

namespace hydroprint::daemon {

/// Retention of assets and uploads, and their repair after a crash. Thread-safe.
class AssetRetention {
 public:
  /// @param keep_unused_ms  how long assets that no job uses are kept; 0: for ever
  AssetRetention(Database& database, const Layout& layout, std::int64_t keep_unused_ms,
                 Clock clock);

  /// Deletes expired uploads and their files. Also deletes, oldest first and with a log entry each,
  /// assets that no job uses and that were last uploaded, or used by a new job, too long ago.
  [[nodiscard]] Status purge();
  /// Repairs the store after a crash: turns verified uploads without an asset row into assets, sets
  /// aside files without a row, and logs rows without a file. Call this before serving clients.
  [[nodiscard]] Status sweep();

 private:
  [[nodiscard]] Status purge_unused();
  [[nodiscard]] Status adopt_completed_uploads();
  [[nodiscard]] Status log_missing_files();

  Database& database_;
  Layout layout_;
  std::int64_t keep_unused_ms_;
  Clock clock_;
};

}  // namespace hydroprint::daemon
