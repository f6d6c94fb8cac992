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

/// Holds an overtaken reply (ReplyFaultKind::kOvertaken) until it is sent.
class OvertakenReply {
 public:
  /// Returns the bytes to send for a frame: it, twice if it is doubled; or nothing, if it is the
  /// one that is overtaken; or preceded by the one held back.
  [[nodiscard]] std::vector<std::uint8_t> bytes_for(const std::vector<std::uint8_t>& frame,
                                                    ReplyFaultKind fault);

 private:
  std::vector<std::uint8_t> held_;
  int followers_ = 0;  // replies sent since it was held back
};

/// Writes all bytes to a descriptor, which may be non-blocking. Gives up if the descriptor is
/// closed, or accepts nothing for 1 s.
void write_all(int descriptor, std::span<const std::uint8_t> bytes);

}  // namespace hydroprint::simulated_drive
