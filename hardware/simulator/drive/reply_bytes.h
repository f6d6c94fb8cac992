#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hardware/simulator/drive/faults.h"

namespace hydroprint::simulated_drive {

/// The bytes of a reply (unit, function, data) on a serial line, damaged as the fault says; none if
/// it never comes.
[[nodiscard]] std::vector<std::uint8_t> serial_frame(std::vector<std::uint8_t> reply,
                                                     ReplyFaultKind fault);

/// The same over TCP, in answer to a request that begins with `header` (six bytes).
[[nodiscard]] std::vector<std::uint8_t> tcp_frame(std::span<const std::uint8_t> header,
                                                  std::vector<std::uint8_t> reply,
                                                  ReplyFaultKind fault);

/// Writes all bytes to a descriptor that may not block; gives up when it is closed.
void write_all(int descriptor, std::span<const std::uint8_t> bytes);

}  // namespace hydroprint::simulated_drive
