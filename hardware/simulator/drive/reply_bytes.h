#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hardware/simulator/drive/faults.h"

namespace hydroprint::simulated_drive {

/// Returns the bytes of a reply (unit, function, data) on a serial line, with the fault applied;
/// empty if the reply is dropped.
[[nodiscard]] std::vector<std::uint8_t> serial_frame(std::vector<std::uint8_t> reply,
                                                     ReplyFaultKind fault);

/// Same as serial_frame(), for TCP, in reply to a request that starts with `header` (six bytes).
[[nodiscard]] std::vector<std::uint8_t> tcp_frame(std::span<const std::uint8_t> header,
                                                  std::vector<std::uint8_t> reply,
                                                  ReplyFaultKind fault);

/// Writes all bytes to a descriptor, which may be non-blocking. Gives up if the descriptor is
/// closed, or accepts nothing for 1 s.
void write_all(int descriptor, std::span<const std::uint8_t> bytes);

}  // namespace hydroprint::simulated_drive
