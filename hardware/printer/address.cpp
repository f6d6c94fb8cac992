#include "hardware/printer/address.h"

#include <cups/cups.h>
#include <fmt/format.h>

#include <array>

namespace hydroprint::printer {

Result<Address> parse_address(const std::string& uri) {
  std::array<char, 32> scheme{};
  std::array<char, 256> user{}, host{}, resource{};
  int port = 0;
  const http_uri_status_t status = httpSeparateURI(
      HTTP_URI_CODING_ALL, uri.c_str(), scheme.data(), scheme.size(), user.data(), user.size(),
      host.data(), host.size(), &port, resource.data(), resource.size());
  const std::string kind = scheme.data();
  if (status < HTTP_URI_STATUS_OK || (kind != "ipp" && kind != "ipps") || host[0] == '\0' ||
      resource[0] != '/') {
    return fail(Code::kInvalidArgument,
                fmt::format("printer '{}': not the address of an IPP printer. Use "
                            "ipp://HOST[:PORT]/ipp/print, or ipps:// for TLS",
                            uri));
  }
  return Address{host.data(), port, resource.data(), kind == "ipps", uri};
}

}  // namespace hydroprint::printer
