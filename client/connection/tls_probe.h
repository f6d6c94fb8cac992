#pragma once

#include <string>

#include "client/connection/connection.h"

namespace hydroprint::client {

/// Explains in one line, with the remedy, why connecting fails although the server listens: the
/// certificate is not trusted, has expired or is for another host, or only one end uses TLS. Empty
/// if none of these applies. Connects once more without sending a request, because gRPC does not
/// report the reason. Takes a few seconds at most.
[[nodiscard]] std::string tls_trouble(const ConnectionOptions& options);

}  // namespace hydroprint::client
