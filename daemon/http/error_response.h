#pragma once

#include <optional>

#include "daemon/http/in_process_channel.h"
#include "daemon/http/protocol/exchange.h"
#include "sim/base/result.h"

namespace hydroprint::http {

/// Answers a request with an error. Returns false if the client has disconnected.
/// @param status  the HTTP status; by default that of the error's code
[[nodiscard]] Task<bool> refuse(Exchange& exchange, Error error, std::optional<int> status = {});

/// Returns the error response for a failed call.
[[nodiscard]] Response refusal(const Reply& reply);

}  // namespace hydroprint::http
