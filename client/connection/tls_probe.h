#pragma once

#include <string>

#include "client/connection/connection.h"

namespace hydroprint::client {

/// Explains in one line, with the remedy, why connecting fails although the server listens: the
/// certificate is not trusted, has expired or names another host, or only one end uses TLS. Empty
/// if none of these applies. gRPC does not report the reason, so this connects once more without
/// sending a request. Takes a few seconds at most.
[[nodiscard]] std::string tls_trouble(const ConnectionOptions& options);

}  // namespace hydroprint::client
