#pragma once

#include <memory>

#include "daemon/http/protocol/socket.h"
#include "daemon/http/server_context.h"

namespace hydroprint::http {

/// Answers the requests of one connection in turn until either side ends it.
Detached serve(ServerContext& server, std::shared_ptr<Socket> socket);

/// Replies that there are too many connections and ends this one.
Detached turn_away(ServerContext& server, std::shared_ptr<Socket> socket);

}  // namespace hydroprint::http
