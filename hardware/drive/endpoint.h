#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::drive {

/// Where a drive is.
struct Endpoint {
  bool serial = false;
  std::string host;  ///< of TCP: an IPv4 address (names are not looked up: that may block)
  int port = 502;
  std::string device;  ///< of RTU: "/dev/serial/by-id/..."
  int baud = 115200;
  char parity = 'E';  ///< 'N', 'E' or 'O'
  int stop_bits = 1;

  /// As parse_endpoint takes it.
  [[nodiscard]] std::string text() const;
};

/// Reads "tcp:192.168.1.20:502" or "rtu:/dev/serial/by-id/X?baud=115200&parity=E&stop=1".
/// Refuses anything else with kInvalidArgument, saying what is wrong and what to write.
[[nodiscard]] Result<Endpoint> parse_endpoint(std::string_view text);

}  // namespace hydroprint::drive
