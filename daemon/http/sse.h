#pragma once

#include "daemon/http/protocol/exchange.h"
#include "daemon/http/server_context.h"
#include "daemon/rest/transcoder.h"

namespace hydroprint::http {

/// Answers a streaming call with server-sent events.
[[nodiscard]] Task<void> answer_events(ServerContext& server, Exchange& exchange, rest::Call call,
                                       InProcessChannel::Metadata metadata);

}  // namespace hydroprint::http
