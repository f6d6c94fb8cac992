#pragma once

#include <memory>

#include "hardware/virtual/body.h"
#include "hardware/virtual/listener.h"

namespace hydroprint::virtual_rig {

/// Serves Modbus TCP on loopback to any number of clients, each at once.
[[nodiscard]] Result<std::unique_ptr<Listener>> serve_tcp(Body& body, int port);

}  // namespace hydroprint::virtual_rig
