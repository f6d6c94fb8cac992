#pragma once

#include <string>

#include "daemon/http/in_process_channel.h"
#include "daemon/http/protocol/exchange.h"
#include "daemon/http/server_context.h"
#include "daemon/rest/transcoder.h"

namespace hydroprint::http {

/// Answers a request for a method of the API.
/// @return the route name for the metrics
[[nodiscard]] Task<std::string> answer_call(ServerContext& server, Exchange& exchange);

/// Makes a call and waits for the response. If the client disconnects, the call is cancelled,
/// unless its method stops motion.
[[nodiscard]] Task<Reply> call(ServerContext& server, Exchange& exchange, rest::Call call,
                               InProcessChannel::Metadata metadata);

}  // namespace hydroprint::http
