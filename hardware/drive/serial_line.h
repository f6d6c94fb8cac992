#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "hardware/drive/transaction.h"

namespace hydroprint::drive {

/// Returns the time needed to send `bytes` on a serial line: each byte has a start bit, 8 data
/// bits, perhaps a parity bit, and stop bits.
[[nodiscard]] inline std::chrono::nanoseconds wire_time(const Endpoint& line, std::size_t bytes) {
  const int bits = 1 + 8 + (line.parity == 'N' ? 0 : 1) + line.stop_bits;
  return std::chrono::nanoseconds(1'000'000'000LL * bits * static_cast<long long>(bytes) /
                                  line.baud);
}

/// Returns the silence between two frames: 3.5 characters, or 1.75 ms above 19200 baud (Modbus over
/// serial line 2.5.1.1).
[[nodiscard]] inline std::chrono::nanoseconds frame_gap(const Endpoint& line) {
  if (line.baud > 19200) return std::chrono::microseconds(1750);
  return wire_time(line, 7) / 2;
}

}  // namespace hydroprint::drive
