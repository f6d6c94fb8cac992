#include "tests/client/late_address.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <vector>

namespace hydroprint::tests {
namespace {

constexpr int kLook_ms = 20;

int new_socket() { return ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0); }

sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// Sends what one socket has received to another; false at the end of the connection.
bool forward(int from, int to) {
  std::array<char, 16384> bytes{};
  const ssize_t got = ::recv(from, bytes.data(), bytes.size(), 0);
  return got > 0 && ::send(to, bytes.data(), static_cast<std::size_t>(got), MSG_NOSIGNAL) == got;
}

}  // namespace

LateAddress::LateAddress(const std::string& daemon) : daemon_(daemon), listener_(new_socket()) {
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, any, size) != 0 || ::listen(listener_, 16) != 0 ||
      ::getsockname(listener_, any, &size) != 0) {
    throw std::runtime_error("cannot listen on a loopback port");
  }
  text_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  thread_ = std::thread([this] { serve(); });
}

LateAddress::~LateAddress() {
  is_over_ = true;
  thread_.join();
  ::close(listener_);
}

void LateAddress::serve() {
  std::map<int, int> peers;  // both directions
  const auto accept = [&] {
    const int client = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (!has_refused_.exchange(true)) return ::close(client);
    const int server = new_socket();
    const sockaddr_in address = loopback(std::stoi(daemon_.substr(daemon_.rfind(':') + 1)));
    peers[client] = server;
    peers[server] = client;
    return ::connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  };
  const auto close = [&](int one) {
    const int other = peers.at(one);
    for (const int each : {one, other}) {
      peers.erase(each);
      ::close(each);
    }
  };
  while (!is_over_) {
    std::vector<pollfd> ready{{listener_, POLLIN, 0}};
    for (const auto& [from, to] : peers) ready.push_back({from, POLLIN, 0});
    ::poll(ready.data(), ready.size(), kLook_ms);
    for (const pollfd& one : ready) {
      if (one.revents == 0 || one.fd == listener_ || !peers.contains(one.fd)) continue;
      if (!forward(one.fd, peers.at(one.fd))) close(one.fd);
    }
    if (ready.front().revents != 0) (void)accept();
  }
  while (!peers.empty()) close(peers.begin()->first);
}

}  // namespace hydroprint::tests
