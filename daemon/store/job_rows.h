#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <vector>

#include "daemon/store/database/database.h"
#include "daemon/store/job.h"

namespace hydroprint::daemon {

/// Returns the number stored for a state or a kind of event.
[[nodiscard]] constexpr std::int64_t number(JobState state) {
  return static_cast<std::int64_t>(state);
}
[[nodiscard]] constexpr std::int64_t number(EventKind kind) {
  return static_cast<std::int64_t>(kind);
}

/// Returns jobs selected by "WHERE ... ORDER BY ... LIMIT ...", without their inputs.
[[nodiscard]] Result<std::vector<Job>> select_jobs(Database& database, const std::string& where,
                                                   std::initializer_list<DbValue> values);

/// Returns one job with its inputs; kNotFound, JOB_NOT_FOUND.
[[nodiscard]] Result<Job> select_job(Database& database, std::int64_t id);

/// Returns events selected by "WHERE ...".
[[nodiscard]] Result<std::vector<JobEvent>> select_events(Database& database,
                                                          const std::string& where,
                                                          std::initializer_list<DbValue> values);

/// Returns artifacts selected by "WHERE ...".
[[nodiscard]] Result<std::vector<Artifact>> select_artifacts(Database& database,
                                                             const std::string& where,
                                                             std::initializer_list<DbValue> values);

/// Returns the integers in the first column of a result.
[[nodiscard]] Result<std::vector<std::int64_t>> select_numbers(
    Database& database, const std::string& sql, std::initializer_list<DbValue> values);

/// Stores an execution as open. Call this within the transaction that starts the job.
/// @return the errors of Database::run(), also if the job already has an open execution
[[nodiscard]] Status insert_execution(Database& database, const Execution& execution);

/// Removes the open execution of a job, if any. Call this within the transaction that ends the job
/// or queues it again.
[[nodiscard]] Status close_execution(Database& database, std::int64_t job);

/// Stores the handle of an open execution; ignored if it is not open any more.
[[nodiscard]] Status store_handle(Database& database, const Execution& execution);

/// Returns the open executions of all jobs, in the order of their jobs.
[[nodiscard]] Result<std::vector<Execution>> select_executions(Database& database);

}  // namespace hydroprint::daemon
