#pragma once

#include <cstdint>
#include <functional>

namespace hydroprint::daemon {

/// A function that returns the Unix time in ms. Tests provide their own.
using Clock = std::function<std::int64_t()>;

/// Reads the machine's clock.
[[nodiscard]] std::int64_t system_clock_ms();

}  // namespace hydroprint::daemon
