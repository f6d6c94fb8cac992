#include "tests/support/control_line.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <thread>

namespace hydroprint::testing {

std::string talk(const std::filesystem::path& path, const std::string& lines) {
  const int out = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  for (int i = 0; i < 6000; ++i) {  // long, for busy machines
    if (::connect(out, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(::send(out, lines.data(), lines.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(lines.size()));
  ::shutdown(out, SHUT_WR);
  std::string reply;
  std::array<char, 512> chunk{};
  for (ssize_t got = 0; (got = ::read(out, chunk.data(), chunk.size())) > 0;) {
    reply.append(chunk.data(), static_cast<std::size_t>(got));
  }
  ::close(out);
  return reply;
}

}  // namespace hydroprint::testing
