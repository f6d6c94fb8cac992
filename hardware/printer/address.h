#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::printer {

/// The address of a printer that speaks the Internet Printing Protocol.
struct Address {
  std::string host;
  int port = 631;
  std::string resource = "/ipp/print";
  bool encrypted = false;
  std::string uri;  ///< the address as given
};

/// Parses "ipp://host[:port]/resource" or "ipps://..."; returns kInvalidArgument otherwise.
[[nodiscard]] Result<Address> parse_address(const std::string& uri);

}  // namespace hydroprint::printer
