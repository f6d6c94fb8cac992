#pragma once

#include <string>
#include <vector>

#include "client/connection/connection.h"
#include "client/job.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// The state of the queue and its workers.
struct Queue {
  bool paused = false;
  std::string pause_reason;
  std::vector<std::string> queued_jobs;  ///< the first 1000, in starting order
  int queued_count = 0;
  std::vector<std::string> running_jobs;
  int worker_slots = 0;
  std::string daemon_version;
};

[[nodiscard]] Result<Queue> get_queue(Connection& connection);

/// Pauses the queue: no further job starts until it is resumed; running jobs continue.
[[nodiscard]] Result<Queue> pause_queue(Connection& connection, const std::string& reason);

[[nodiscard]] Result<Queue> resume_queue(Connection& connection);

/// Moves a queued job in front of another one of the same owner; if `before` is empty, behind all
/// of them.
[[nodiscard]] Result<Job> move_job(Connection& connection, const std::string& name,
                                   const std::string& before);

}  // namespace hydroprint::client
