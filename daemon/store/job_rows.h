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

/// Joins lines for storage, for example flags: one per line.
[[nodiscard]] std::string join_lines(const std::vector<std::string>& lines);

}  // namespace hydroprint::daemon
