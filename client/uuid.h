#pragma once

#include <string>

namespace hydroprint::client {

/// A random UUID (version 4) in its usual spelling, for request_id.
[[nodiscard]] std::string make_uuid();

}  // namespace hydroprint::client
