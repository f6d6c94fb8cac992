#pragma once

#include <chrono>

namespace hydroprint::client {

/// A point in time as the daemon tells it.
using Time = std::chrono::system_clock::time_point;

}  // namespace hydroprint::client
