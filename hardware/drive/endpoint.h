#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::drive {

/// The address of a drive.
struct Endpoint {
  bool serial = false;
  std::string host;  ///< for TCP: an IPv4 address (a name lookup could block)
  int port = 502;
  std::string device;  ///< for RTU: "/dev/serial/by-id/..."
  int baud = 115200;
  char parity = 'E';  ///< 'N', 'E' or 'O'
  int stop_bits = 1;

  /// Formats the endpoint as text that parse_endpoint() accepts.
  [[nodiscard]] std::string text() const;
};

/// Parses "tcp:192.168.1.20:502" or "rtu:/dev/serial/by-id/X?baud=115200&parity=E&stop=1". Returns
/// kInvalidArgument with the fault and the expected format for other text.
[[nodiscard]] Result<Endpoint> parse_endpoint(std::string_view text);

}  // namespace hydroprint::drive
