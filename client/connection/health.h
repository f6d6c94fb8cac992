#pragma once

#include <string>

#include "client/connection/connection.h"
#include "sim/base/result.h"

namespace hydroprint::client {

/// What grpc.health.v1.Health says of the daemon as a whole: "SERVING", "NOT_SERVING" or "UNKNOWN".
[[nodiscard]] Result<std::string> check_health(Connection& connection);

}  // namespace hydroprint::client
