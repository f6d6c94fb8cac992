#include "client/connection/server_address.h"

#include <fmt/format.h>

#include <charconv>

namespace hydroprint::client {
namespace {

constexpr std::string_view kTls = "https://";

bool is_port(std::string_view text, int& port) {
  const auto end = std::from_chars(text.data(), text.data() + text.size(), port);
  return end.ec == std::errc() && end.ptr == text.data() + text.size() && port > 0 && port < 65536;
}

}  // namespace

std::string ServerAddress::text() const {
  const bool is_v6 = host.find(':') != std::string::npos;
  return is_v6 ? fmt::format("[{}]:{}", host, port) : fmt::format("{}:{}", host, port);
}

bool ServerAddress::is_loopback() const {
  return host == "localhost" || host == "::1" ||
         (host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos);
}

Result<ServerAddress> parse_server(std::string_view text) {
  const auto refused =
      fail(Code::kInvalidArgument,
           fmt::format("'{}' is not a server address. Use host:port (127.0.0.1:50051), or "
                       "https://host:port for TLS (https://rig.example.org:50051)",
                       text));
  ServerAddress address;
  address.is_tls = text.starts_with(kTls);
  if (address.is_tls) text.remove_prefix(kTls.size());
  if (address.is_tls && text.ends_with('/')) text.remove_suffix(1);
  const std::size_t bracket = text.rfind(']');
  const std::size_t colon = text.rfind(':');
  const bool has_port =
      colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket);
  if (has_port && !is_port(text.substr(colon + 1), address.port)) return refused;
  if (!has_port && !address.is_tls) return refused;
  std::string_view host = has_port ? text.substr(0, colon) : text;
  const bool is_bracketed = host.starts_with('[') && host.ends_with(']');
  if (is_bracketed) host = host.substr(1, host.size() - 2);
  const bool is_odd = host.find_first_of("/@?#[] ") != std::string_view::npos;
  const bool is_bare_v6 = !is_bracketed && host.find(':') != std::string_view::npos;
  if (host.empty() || is_odd || is_bare_v6) return refused;
  address.host = host;
  return address;
}

}  // namespace hydroprint::client
