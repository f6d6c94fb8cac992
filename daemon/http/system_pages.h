#pragma once

#include <string>

#include "daemon/http/protocol/exchange.h"
#include "daemon/http/server_context.h"

namespace hydroprint::http {

// Each function answers one request and returns the route name for the metrics.

/// Serves a file of the web client.
[[nodiscard]] Task<std::string> answer_file(ServerContext& server, Exchange& exchange);
/// Serves /healthz.
[[nodiscard]] Task<std::string> answer_health(ServerContext& server, Exchange& exchange);
/// Serves /metrics.
[[nodiscard]] Task<std::string> answer_metrics(ServerContext& server, Exchange& exchange);

}  // namespace hydroprint::http
