#pragma once

#include <memory>

#include "daemon/http/protocol/transport.h"
#include "daemon/tls/identity.h"

namespace hydroprint::http {

/// Bytes within TLS, as its server.
/// @param socket  a descriptor that does not block
/// @return null if there is no memory
[[nodiscard]] std::unique_ptr<Transport> tls_transport(
    int socket, std::shared_ptr<const tls::Identity> identity);

}  // namespace hydroprint::http
