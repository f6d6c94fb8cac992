#pragma once

#include <cstdint>
#include <string>

#include "daemon/store/database/database.h"

namespace hydroprint::daemon {

/// How much one owner may have; 0: any number.
struct Quota {
  std::int64_t max_queued_jobs = 0;
  std::int64_t max_stored_bytes = 0;
};

/// How much one owner has.
struct Usage {
  std::int64_t queued_jobs = 0;
  std::int64_t stored_bytes = 0;  ///< of assets, open uploads (as announced) and artifacts
  std::int64_t pinned_bytes = 0;  ///< of these, those of pinned jobs
};

/// Errors as Database::each().
[[nodiscard]] Result<Usage> usage_of(Database& database, const std::string& owner);

/// Refuses (kResourceExhausted, QUOTA_EXCEEDED with metadata `quota`, `used`, `allowed`) one more
/// job to an owner who has none left, in the queue (if it `is_queued`) or in bytes. To be called
/// within the transaction that stores it, as the next.
[[nodiscard]] Status check_job_quota(Database& database, const std::string& owner,
                                     const Quota& quota, bool is_queued);

/// The same of so many more bytes.
[[nodiscard]] Status check_byte_quota(Database& database, const std::string& owner,
                                      const Quota& quota, std::int64_t more_bytes);

}  // namespace hydroprint::daemon
