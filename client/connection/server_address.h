#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::client {

/// The address of a daemon, and whether it speaks TLS.
struct ServerAddress {
  std::string host;  ///< "rig.example.org", "127.0.0.1", "::1"
  int port = 50051;
  bool is_tls = false;

  /// Returns "rig.example.org:50051" or "[::1]:50051".
  [[nodiscard]] std::string text() const;
  /// Returns whether the host is "localhost" or a loopback address. Any other name of this machine
  /// could be redirected to another machine.
  [[nodiscard]] bool is_loopback() const;
};

/// Parses "127.0.0.1:50051", "rig.example.org:50051", or "https://rig.example.org:50051" (TLS; the
/// default port is 50051).
/// @return kInvalidArgument for anything else
[[nodiscard]] Result<ServerAddress> parse_server(std::string_view text);

}  // namespace hydroprint::client
