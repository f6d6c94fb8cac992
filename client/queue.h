#pragma once

#include <string>

#include "client/connection/connection.h"
#include "hydroprint/v1/queue_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::client {

[[nodiscard]] Result<v1::Queue> get_queue(Connection& connection);

/// Pauses the queue: no further job starts until it is resumed; running jobs continue.
[[nodiscard]] Result<v1::Queue> pause_queue(Connection& connection, const std::string& reason);

[[nodiscard]] Result<v1::Queue> resume_queue(Connection& connection);

/// Moves a queued job in front of another one of the same owner, or to the end if `before` is
/// empty.
[[nodiscard]] Result<v1::Job> move_job(Connection& connection, const std::string& name,
                                       const std::string& before);

}  // namespace hydroprint::client
