#pragma once

#include <string>

#include "sim/base/result.h"

namespace hydroprint::printer {

/// Where a printer speaks the Internet Printing Protocol.
struct Address {
  std::string host;
  int port = 631;
  std::string resource = "/ipp/print";
  bool encrypted = false;
  std::string uri;  ///< as given
};

/// Reads "ipp://host[:port]/resource" or "ipps://...". Refuses anything else (kInvalidArgument).
[[nodiscard]] Result<Address> parse_address(const std::string& uri);

}  // namespace hydroprint::printer
