#pragma once

#include <string>

#include "daemon/http/protocol/exchange.h"
#include "daemon/http/server_context.h"

namespace hydroprint::http {

/// Answers one request: rejects it, or passes it to the handler for its path.
/// @return the route name for the metrics
[[nodiscard]] Task<std::string> answer(ServerContext& server, Exchange& exchange);

}  // namespace hydroprint::http
