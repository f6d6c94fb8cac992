#pragma once

#include <string>

#include "daemon/http/protocol/exchange.h"
#include "daemon/http/server_context.h"

namespace hydroprint::http {

/// Answers one request: refuses it, or passes it to the handler for its path.
/// @return the name under which the request is counted
[[nodiscard]] Task<std::string> answer(ServerContext& server, Exchange& exchange);

}  // namespace hydroprint::http
