#pragma once

#include <string>

#include "client/connection/connection.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// Returns the daemon's status in grpc.health.v1.Health: "SERVING", "NOT_SERVING" or "UNKNOWN".
[[nodiscard]] Result<std::string> check_health(Connection& connection);

}  // namespace hydroprint::client
