#include "hardware/drive/connection.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <modbus/modbus.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "hardware/drive/serial_line.h"

namespace hydroprint::drive {
namespace {

constexpr std::size_t kTcpHeader = 6;  // bytes before the unit id
constexpr std::size_t kCrc = 2;

tl::unexpected<Error> offline(const Endpoint& endpoint, const std::string& what) {
  return fail(Code::kUnavailable, "drive at " + endpoint.text() + ": " + what, "RIG_OFFLINE");
}

std::string serial_remedy(int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return "no such device. Plug in the adapter, or correct the path";
    case EACCES:
    case EPERM:
      return "permission denied. Add this user to the group that owns the device";
    case EBUSY:
    case EWOULDBLOCK:
      return "in use by another program. Stop that program";
    default:
      return std::string(std::strerror(error)) + ". Check the adapter";
  }
}

/// Returns false for large descriptors, which select() in libmodbus cannot watch.
bool can_be_watched(int descriptor) { return descriptor < FD_SETSIZE; }

bool wait_connected(int socket, std::chrono::milliseconds patience) {
  pollfd wait{socket, POLLOUT, 0};
  int ready = 0;
  do {
    ready = ::poll(&wait, 1, static_cast<int>(patience.count()));
  } while (ready < 0 && errno == EINTR);
  if (ready == 0) errno = ETIMEDOUT;
  if (ready <= 0) return false;
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
  errno = error;
  return error == 0;
}

/// Returns a connected non-blocking socket; -1 with errno on failure.
int connect_socket(const Endpoint& endpoint, std::chrono::milliseconds patience) {
  const int out = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (out < 0) return out;
  const int on = 1;
  ::setsockopt(out, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  ::setsockopt(out, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(endpoint.port));
  ::inet_pton(AF_INET, endpoint.host.c_str(), &address.sin_addr);
  const bool done =
      ::connect(out, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (done || (errno == EINPROGRESS && wait_connected(out, patience))) return out;
  const int error = errno;
  ::close(out);
  errno = error;
  return -1;
}

bool is_lost(int error) {
  switch (error) {
    case EIO:
    case ENXIO:
    case ENODEV:
    case EBADF:
    case EPIPE:
    case ECONNRESET:
    case ECONNREFUSED:
    case ENOTCONN:
      return true;
    default:
      return false;
  }
}

Connection::End end_of(int error) {
  if (error == ETIMEDOUT) return Connection::End::kTimeout;
  return is_lost(error) ? Connection::End::kLost : Connection::End::kDamaged;
}

}  // namespace

Connection::Connection(const Endpoint& endpoint, const LinkTiming& timing, _modbus* modbus)
    : endpoint_(endpoint), timing_(timing), modbus_(modbus) {}

Connection::~Connection() {
  if (owns_) ::ioctl(lock_, TIOCNXCL);
  modbus_close(modbus_);
  modbus_free(modbus_);
  if (lock_ >= 0) ::close(lock_);
}

Result<std::unique_ptr<Connection>> Connection::open(const Endpoint& endpoint,
                                                     const LinkTiming& timing) {
  modbus_t* modbus = endpoint.serial ? modbus_new_rtu(endpoint.device.c_str(), endpoint.baud,
                                                      endpoint.parity, 8, endpoint.stop_bits)
                                     : modbus_new_tcp(endpoint.host.c_str(), endpoint.port);
  if (modbus == nullptr)
    return offline(endpoint, "not a valid address. Use tcp:ADDRESS:PORT or rtu:DEVICE");
  std::unique_ptr<Connection> out(new Connection(endpoint, timing, modbus));
  modbus_set_error_recovery(modbus, MODBUS_ERROR_RECOVERY_NONE);
  // Without a timeout between bytes, the response timeout limits the whole reply.
  modbus_set_byte_timeout(modbus, 0, 0);
  HP_RETURN_IF_ERROR(endpoint.serial ? out->open_serial() : out->open_tcp());
  if (!can_be_watched(modbus_get_socket(modbus))) {
    return offline(endpoint, "this process has too many open files. Restart it");
  }
  return out;
}

namespace {

/// Changes the speed of a serial line, so that it accepts libmodbus's settings. A line without a
/// parity bit, such as a pseudo-terminal, refuses settings that differ from its own only in parity.
/// Those occur after a process was killed with the line open, because its settings remain.
void forget_settings(int line) {
  termios settings{};
  if (::tcgetattr(line, &settings) != 0) return;
  ::cfsetspeed(&settings, ::cfgetospeed(&settings) == B1200 ? B2400 : B1200);
  ::tcsetattr(line, TCSANOW, &settings);
}

}  // namespace

Status Connection::open_tcp() {
  const int socket = connect_socket(endpoint_, timing_.connect);
  if (socket < 0) {
    return offline(endpoint_,
                   std::string(std::strerror(errno)) + ". Check the power and the address");
  }
  modbus_set_socket(modbus_, socket);
  return {};
}

Status Connection::open_serial() {
  // The lock is taken before libmodbus changes settings that another program may be using.
  lock_ = ::open(endpoint_.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (lock_ < 0) return offline(endpoint_, serial_remedy(errno));
  if (::isatty(lock_) == 0) return offline(endpoint_, "not a serial line. Correct the path");
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) return offline(endpoint_, serial_remedy(errno));
  forget_settings(lock_);
  if (modbus_connect(modbus_) != 0) return offline(endpoint_, serial_remedy(errno));
  owns_ = ::ioctl(lock_, TIOCEXCL) == 0;
  return {};
}

Connection::End Connection::exchange(int unit, const std::vector<std::uint8_t>& request,
                                     std::size_t reply_bytes, std::vector<std::uint8_t>& reply,
                                     std::string& cause) {
  std::chrono::microseconds patience = timing_.response;
  if (endpoint_.serial) {
    patience += std::chrono::duration_cast<std::chrono::microseconds>(
        wire_time(endpoint_, request.size() + reply_bytes + 2 * kCrc) + 2 * frame_gap(endpoint_));
  }
  modbus_set_response_timeout(modbus_, static_cast<std::uint32_t>(patience.count() / 1'000'000),
                              static_cast<std::uint32_t>(patience.count() % 1'000'000));
  modbus_set_slave(modbus_, unit);
  if (modbus_flush(modbus_) < 0 ||
      modbus_send_raw_request(modbus_, request.data(), static_cast<int>(request.size())) < 0) {
    cause = modbus_strerror(errno);
    return End::kLost;
  }
  return receive(reply, cause);
}

Connection::End Connection::receive(std::vector<std::uint8_t>& reply, std::string& cause) {
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> adu{};
  const int got = modbus_receive_confirmation(modbus_, adu.data());
  if (got < 0) {
    cause = modbus_strerror(errno);
    return end_of(errno);
  }
  const std::size_t size = static_cast<std::size_t>(got);
  const std::size_t head = endpoint_.serial ? 0 : kTcpHeader;
  const std::size_t tail = endpoint_.serial ? kCrc : 0;
  if (size < head + tail + 2) {  // 0: libmodbus dropped the reply of another unit
    cause = "reply of another unit";
    return End::kDamaged;
  }
  const bool is_framed =
      endpoint_.serial || (adu[0] == 0 && adu[1] == 0 && adu[2] == 0 && adu[3] == 0 &&
                           (adu[4] << 8U | adu[5]) == static_cast<int>(size - head));
  if (!is_framed) {
    cause = "wrong header";
    return End::kDamaged;
  }
  reply.assign(adu.begin() + head, adu.begin() + static_cast<std::ptrdiff_t>(size - tail));
  return End::kReply;
}

}  // namespace hydroprint::drive
