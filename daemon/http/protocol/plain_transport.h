#pragma once

#include <memory>

#include "daemon/http/protocol/transport.h"

namespace hydroprint::http {

/// Creates a transport without encryption.
/// @param socket  non-blocking descriptor
[[nodiscard]] std::unique_ptr<Transport> plain_transport(int socket);

}  // namespace hydroprint::http
