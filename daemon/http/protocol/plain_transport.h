#pragma once

#include <memory>

#include "daemon/http/protocol/transport.h"

namespace hydroprint::http {

/// Bytes as they are.
/// @param socket  a descriptor that does not block
[[nodiscard]] std::unique_ptr<Transport> plain_transport(int socket);

}  // namespace hydroprint::http
