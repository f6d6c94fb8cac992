#include "client/loop/control.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <iomanip>
#include <sstream>

namespace hydroprint::loop {
namespace {

constexpr timeval kPatience{10, 0};

std::string converse(int line, const std::string& text) {
  std::string reply;
  if (::send(line, text.data(), text.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(text.size()))
    return reply;
  ::shutdown(line, SHUT_WR);
  std::array<char, 4096> chunk{};
  for (ssize_t got = 0; (got = ::read(line, chunk.data(), chunk.size())) > 0;)
    reply.append(chunk.data(), static_cast<std::size_t>(got));
  return reply.substr(0, reply.find('\n'));
}

}  // namespace

std::string quoted(const std::filesystem::path& path) {
  std::ostringstream out;
  out << std::quoted(path.string());
  return out.str();
}

Result<std::string> talk(const std::filesystem::path& control, const std::string& text) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::string reply;
  if (control.native().size() < sizeof address.sun_path) {
    std::memcpy(address.sun_path, control.c_str(), control.native().size());
    const int line = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    ::setsockopt(line, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
    if (::connect(line, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
      reply = converse(line, text + "\n");
    ::close(line);
  }
  if (reply.empty()) {
    return fail(Code::kUnavailable, fmt::format("{}: no virtual rig responds; use the path that "
                                                "hydroprint-virtual-rig was given with --control",
                                                control.string()));
  }
  if (!reply.starts_with("error: ")) return reply;
  return fail(Code::kInvalidArgument, "virtual rig: " + reply.substr(7));
}

}  // namespace hydroprint::loop
