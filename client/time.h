#pragma once

#include <chrono>

namespace hydroprint::client {

/// A point in time on the daemon's clock.
using Time = std::chrono::system_clock::time_point;

}  // namespace hydroprint::client
