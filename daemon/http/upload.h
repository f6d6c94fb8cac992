#pragma once

#include <string>

#include "daemon/http/protocol/exchange.h"
#include "daemon/http/server_context.h"

namespace hydroprint::http {

/// Answers a request for the bytes of an upload (PATCH, HEAD).
/// @return the route name for the metrics
[[nodiscard]] Task<std::string> answer_upload(ServerContext& server, Exchange& exchange);

}  // namespace hydroprint::http
