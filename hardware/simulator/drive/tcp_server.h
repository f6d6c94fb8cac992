#pragma once

#include <memory>

#include "hardware/simulator/drive/plant.h"
#include "hardware/simulator/drive/socket_server.h"

namespace hydroprint::simulated_drive {

/// Serves Modbus TCP on loopback to any number of clients in parallel.
[[nodiscard]] Result<std::unique_ptr<SocketServer>> serve_tcp(Plant& plant, int port);

}  // namespace hydroprint::simulated_drive
