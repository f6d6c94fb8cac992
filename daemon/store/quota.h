#pragma once

#include <cstdint>
#include <string>

#include "daemon/store/database/database.h"

namespace hydroprint::daemon {

/// Limits for one owner; 0: no limit.
struct Quota {
  std::int64_t max_queued_jobs = 0;
  std::int64_t max_stored_bytes = 0;
};

/// Resources that one owner uses.
struct Usage {
  std::int64_t queued_jobs = 0;
  /// Assets, open uploads (with their announced size) and artifacts.
  std::int64_t stored_bytes = 0;
  std::int64_t pinned_bytes = 0;  ///< the part of stored_bytes that belongs to pinned jobs
};

/// Reads an owner's usage. Errors as in Database::each().
[[nodiscard]] Result<Usage> usage_of(Database& database, const std::string& owner);

/// Returns kResourceExhausted, QUOTA_EXCEEDED (metadata `quota`, `used`, `allowed`) if an owner
/// cannot have another job. This is the case if the quota of bytes or, if `is_queued`, of queued
/// jobs is used up. Call this within the transaction that then stores the job.
[[nodiscard]] Status check_job_quota(Database& database, const std::string& owner,
                                     const Quota& quota, bool is_queued);

/// Same as check_job_quota(), for `more_bytes` more bytes.
[[nodiscard]] Status check_byte_quota(Database& database, const std::string& owner,
                                      const Quota& quota, std::int64_t more_bytes);

}  // namespace hydroprint::daemon
