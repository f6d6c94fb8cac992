#pragma once

#include <memory>

#include "daemon/http/protocol/socket.h"
#include "daemon/http/server_context.h"

namespace hydroprint::http {

/// Serves the requests of one connection one after the other until either side closes it.
Detached serve(ServerContext& server, std::shared_ptr<Socket> socket);

/// Sends an error response because too many connections are open, and closes `socket`.
Detached turn_away(ServerContext& server, std::shared_ptr<Socket> socket);

}  // namespace hydroprint::http
