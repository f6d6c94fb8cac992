#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/store/job_changes.h"

namespace hydroprint::daemon {

/// Jobs that the rig or the printer carries out. They are never queued, and only one of each kind
/// is open at a time. Errors as in JobChanges. Thread-safe.
class DeviceJobs {
 public:
  explicit DeviceJobs(JobChanges& changes) : changes_(changes), database_(changes.database()) {}

  /// Updates an unfinished dip or print: its state (WAITING_FOR_OPERATOR or RUNNING), its
  /// `dip_status` (dips only) and its progress. Ignored for a job that is CANCELLING.
  [[nodiscard]] Status advance(std::int64_t id, JobState state, const std::string& dip_status,
                               const Progress& progress, const std::string& message);
  /// Ends a dip or print and stores its record: SUCCEEDED, FAILED (with the complete reason in
  /// `failure`), CANCELLED or INTERRUPTED.
  [[nodiscard]] Result<Job> end(std::int64_t id, JobState state,
                                const std::optional<JobFailure>& failure,
                                const std::string& dip_status, const std::vector<Artifact>& record,
                                const std::string& message);
  /// Returns unfinished dips, without their inputs; at most one, except after a crash.
  [[nodiscard]] Result<std::vector<Job>> open_dips();

 private:
  JobChanges& changes_;
  Database& database_;
};

/// Returns STATE_FORBIDS if a job of the kind `verb` is not finished. Call this within the
/// transaction that then stores the job.
[[nodiscard]] Status check_none_open(Database& database, const std::string& verb);

/// Stores the current status of a dip. Call this within a transaction.
[[nodiscard]] Status store_dip_status(Database& database, std::int64_t id,
                                      const std::string& dip_status);

}  // namespace hydroprint::daemon
