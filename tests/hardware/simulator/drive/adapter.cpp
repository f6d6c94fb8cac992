#include "tests/hardware/simulator/drive/adapter.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <span>
#include <stdexcept>

namespace hydroprint::simulated_drive {
namespace {

using Buffer = std::array<std::uint8_t, 512>;

constexpr std::size_t kUnitPlace = 6;  // in a TCP frame

sockaddr_in loopback(int port) {
  sockaddr_in out{};
  out.sin_family = AF_INET;
  out.sin_port = htons(static_cast<std::uint16_t>(port));
  out.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return out;
}

void make_raw(int terminal) {
  termios settings{};
  ::tcgetattr(terminal, &settings);
  ::cfmakeraw(&settings);
  ::tcsetattr(terminal, TCSANOW, &settings);
}

void put(int descriptor, std::span<const std::uint8_t> bytes) {
  if (::write(descriptor, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("the adapter cannot write");
  }
}

}  // namespace

Adapter::Adapter(Kind kind, const BenchRig& bench) : kind_(kind) {
  const bool is_serial = kind == Kind::kEcho || kind == Kind::kDeafEcho;
  is_serial ? open_serial() : open_tcp();
  open_drive(bench.endpoint());
  thread_ = std::thread([this] { run(); });
}

Adapter::~Adapter() {
  ends_ = true;
  thread_.join();
  for (const int each : {listener_, client_, slave_, drive_}) {
    if (each >= 0) ::close(each);
  }
}

void Adapter::open_serial() {
  client_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::array<char, 128> name{};
  if (client_ < 0 || ::grantpt(client_) != 0 || ::unlockpt(client_) != 0 ||
      ::ptsname_r(client_, name.data(), name.size()) != 0) {
    throw std::runtime_error("no pseudo-terminal is available");
  }
  slave_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  make_raw(slave_);
  endpoint_.serial = true;
  endpoint_.device = name.data();
}

void Adapter::open_tcp() {
  listener_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      ::listen(listener_, 4) != 0) {
    throw std::runtime_error("no port is available");
  }
  ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
  endpoint_.host = "127.0.0.1";
  endpoint_.port = ntohs(address.sin_port);
}

void Adapter::open_drive(const drive::Endpoint& drive) {
  if (drive.serial) {
    drive_ = ::open(drive.device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    return make_raw(drive_);
  }
  drive_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(drive.port);
  if (::connect(drive_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    throw std::runtime_error("the rig does not accept a connection");
  }
}

void Adapter::accept_client() { client_ = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC); }

/// Returns false if the client has closed its connection.
bool Adapter::forward_request() {
  Buffer buffer{};
  const ssize_t got = ::read(client_, buffer.data(), buffer.size());
  if (got <= 0) return false;
  const auto bytes = std::span(buffer).first(static_cast<std::size_t>(got));
  if (kind_ == Kind::kEcho || kind_ == Kind::kDeafEcho) put(client_, bytes);
  if (kind_ != Kind::kDeafEcho) put(drive_, bytes);
  return true;
}

void Adapter::forward_reply() {
  Buffer buffer{};
  const ssize_t got = ::read(drive_, buffer.data(), buffer.size());
  if (got <= 0 || client_ < 0) return;
  if (kind_ == Kind::kUnit255) buffer.at(kUnitPlace) = 255;
  put(client_, std::span(buffer).first(static_cast<std::size_t>(got)));
}

void Adapter::run() {
  while (!ends_) {
    std::array<pollfd, 3> wait = {
        {{client_ < 0 ? listener_ : -1, POLLIN, 0}, {client_, POLLIN, 0}, {drive_, POLLIN, 0}}};
    ::poll(wait.data(), wait.size(), 20);
    if (wait[0].revents != 0) accept_client();
    if (wait[1].revents != 0 && !forward_request() && listener_ >= 0) {
      ::close(client_);
      client_ = -1;
    }
    if (wait[2].revents != 0) forward_reply();
  }
}

}  // namespace hydroprint::simulated_drive
