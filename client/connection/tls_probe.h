#pragma once

#include <string>

#include "client/connection/connection.h"

namespace hydroprint::client {

/// Why there is no connection although something listens there, in one line with the remedy: a
/// certificate that is not trusted, has expired or is for another name; TLS spoken by one end only.
/// Empty: none of these. gRPC does not tell; so the server is asked once more, without sending it
/// anything. Takes a few seconds at most.
[[nodiscard]] std::string tls_trouble(const ConnectionOptions& options);

}  // namespace hydroprint::client
