#pragma once

#include <string>

namespace hydroprint::client {

/// Returns a random UUID (version 4) in the usual notation, for request_id.
[[nodiscard]] std::string make_uuid();

}  // namespace hydroprint::client
