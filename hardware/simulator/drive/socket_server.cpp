#include "hardware/simulator/drive/socket_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "hardware/simulator/drive/plant.h"
#include "sim/base/process/real_time_thread.h"

namespace hydroprint::simulated_drive {
namespace {

constexpr int kBacklog = 16;
constexpr int kPollInterval_ms = 20;

tl::unexpected<Error> refuse(const std::string& place, int error) {
  return fail(Code::kFailedPrecondition,
              fmt::format("cannot listen on {} ({}). Use another address, or stop the program "
                          "that uses it",
                          place, std::strerror(error)));
}

template <class Address>
Result<int> listen_at(int family, const Address& address, const std::string& place) {
  const int out = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int on = 1;
  if (out >= 0) ::setsockopt(out, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (out >= 0 && ::bind(out, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      ::listen(out, kBacklog) == 0) {
    return out;
  }
  const int error = errno;
  if (out >= 0) ::close(out);
  return refuse(place, error);
}

}  // namespace

Result<std::unique_ptr<SocketServer>> SocketServer::tcp(int port, Serve serve) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  HP_ASSIGN_OR_RETURN(const int socket,
                      listen_at(AF_INET, address, fmt::format("127.0.0.1:{}", port)));
  std::unique_ptr<SocketServer> out(new SocketServer(socket, std::move(serve)));
  socklen_t size = sizeof address;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  out->port_ = ntohs(address.sin_port);
  return out;
}

Result<std::unique_ptr<SocketServer>> SocketServer::local(const std::filesystem::path& path,
                                                          Serve serve) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.native().size() >= sizeof address.sun_path) return refuse(path.string(), ENAMETOOLONG);
  std::memcpy(address.sun_path, path.c_str(), path.native().size());
  if (std::error_code error; std::filesystem::is_socket(path, error)) ::unlink(path.c_str());
  const mode_t before = ::umask(077);
  auto socket = listen_at(AF_UNIX, address, path.string());
  ::umask(before);
  if (!socket) return tl::unexpected(std::move(socket).error());
  return std::unique_ptr<SocketServer>(new SocketServer(*socket, std::move(serve)));
}

SocketServer::SocketServer(int socket, Serve serve)
    : socket_(socket), serve_(std::move(serve)), thread_([this] { accept_all(); }) {}

SocketServer::~SocketServer() {
  ends_ = true;
  thread_.join();
  ::close(socket_);
}

void SocketServer::accept_all() {
  (void)become_real_time(kDrivePriority);
  while (!ends_) {
    pollfd wait{socket_, POLLIN, 0};
    ::poll(&wait, 1, kPollInterval_ms);
    const int descriptor = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    if (descriptor >= 0) admit(descriptor);
    part(false);
  }
  part(true);
}

void SocketServer::admit(int descriptor) {
  const int on = 1;
  ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);  // fails on local sockets
  Client& client = clients_.emplace_back();
  client.descriptor = descriptor;
  client.thread = std::thread([this, &client] {
    serve_(client.descriptor);
    ::shutdown(client.descriptor, SHUT_RDWR);
    client.gone = true;
  });
}

void SocketServer::part(bool all) {
  if (all) {
    for (const Client& client : clients_) ::shutdown(client.descriptor, SHUT_RDWR);
  }
  for (auto client = clients_.begin(); client != clients_.end();) {
    if (!all && !client->gone) {
      ++client;
      continue;
    }
    client->thread.join();
    ::close(client->descriptor);
    client = clients_.erase(client);
  }
}

}  // namespace hydroprint::simulated_drive
