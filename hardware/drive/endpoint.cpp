#include "hardware/drive/endpoint.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace hydroprint::drive {
namespace {

constexpr std::array<int, 8> kBauds = {1200, 4800, 9600, 19200, 38400, 57600, 115200, 230400};

tl::unexpected<Error> refuse(std::string_view text, const std::string& what) {
  return fail(Code::kInvalidArgument,
              fmt::format("drive at \"{}\": {}. Use tcp:192.168.1.20:502 or "
                          "rtu:/dev/serial/by-id/NAME?baud=115200&parity=E&stop=1",
                          text, what),
              ErrorReason::CONFIG_INVALID);
}

bool read_number(std::string_view text, int& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size();
}

Result<Endpoint> parse_tcp(std::string_view all, std::string_view rest) {
  Endpoint out;
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string_view::npos) return refuse(all, "the port is missing");
  out.host = rest.substr(0, colon);
  if (out.host == "localhost") out.host = "127.0.0.1";
  in_addr address{};
  if (inet_pton(AF_INET, out.host.c_str(), &address) != 1) {
    return refuse(all, "the host is not an IPv4 address (host names are not supported)");
  }
  if (!read_number(rest.substr(colon + 1), out.port) || out.port < 1 || out.port > 65535) {
    return refuse(all, "the port is not a number from 1 to 65535");
  }
  return out;
}

bool set_option(std::string_view name, std::string_view value, Endpoint& out) {
  if (name == "baud") {
    return read_number(value, out.baud) &&
           std::find(kBauds.begin(), kBauds.end(), out.baud) != kBauds.end();
  }
  if (name == "stop") return read_number(value, out.stop_bits) && (value == "1" || value == "2");
  if (name != "parity" || (value != "N" && value != "E" && value != "O")) return false;
  out.parity = value[0];
  return true;
}

Result<Endpoint> parse_rtu(std::string_view all, std::string_view rest) {
  Endpoint out;
  out.serial = true;
  const std::size_t question = rest.find('?');
  out.device = rest.substr(0, question);
  if (out.device.empty() || out.device[0] != '/')
    return refuse(all, "the device path is not absolute");
  if (question == std::string_view::npos) return out;
  std::string_view options = rest.substr(question + 1);
  while (!options.empty()) {
    const std::size_t end = std::min(options.find('&'), options.size());
    const std::string_view option = options.substr(0, end);
    const std::size_t equals = std::min(option.find('='), option.size());
    if (equals == option.size() ||
        !set_option(option.substr(0, equals), option.substr(equals + 1), out)) {
      return refuse(all, fmt::format("the option \"{}\" is not valid", option));
    }
    options.remove_prefix(std::min(end + 1, options.size()));
  }
  return out;
}

}  // namespace

std::string Endpoint::text() const {
  if (!serial) return fmt::format("tcp:{}:{}", host, port);
  return fmt::format("rtu:{}?baud={}&parity={}&stop={}", device, baud, parity, stop_bits);
}

Result<Endpoint> parse_endpoint(std::string_view text) {
  const bool has_control_character =
      std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; });
  if (has_control_character) return refuse("...", "contains a control character");
  if (text.starts_with("tcp:")) return parse_tcp(text, text.substr(4));
  if (text.starts_with("rtu:")) return parse_rtu(text, text.substr(4));
  return refuse(text, "starts with neither tcp: nor rtu:");
}

}  // namespace hydroprint::drive
