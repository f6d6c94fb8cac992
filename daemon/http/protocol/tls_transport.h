#pragma once

#include <memory>

#include "daemon/http/protocol/transport.h"
#include "daemon/tls/identity.h"

namespace hydroprint::http {

/// Creates a transport with TLS, for the server side.
/// @param socket  non-blocking descriptor
/// @return null if memory is exhausted
[[nodiscard]] std::unique_ptr<Transport> tls_transport(
    int socket, std::shared_ptr<const tls::Identity> identity);

}  // namespace hydroprint::http
