#include "hardware/drive/connection.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <modbus/modbus.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "hardware/drive/serial_line.h"

namespace hydroprint::drive {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kChunk = 512;
// Bytes of the longest frame; more input than this is not waited for.
constexpr std::size_t kLongestFrame = 256;

tl::unexpected<Error> offline(const Endpoint& endpoint, const std::string& what) {
  return fail(Code::kUnavailable, "drive at " + endpoint.text() + ": " + what,
              ErrorReason::RIG_OFFLINE);
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

}  // namespace

Connection::~Connection() {
  if (owns_) ::ioctl(lock_, TIOCNXCL);
  if (modbus_ != nullptr) {
    modbus_close(modbus_);
    modbus_free(modbus_);
  } else if (line_ >= 0) {
    ::close(line_);
  }
  if (lock_ >= 0) ::close(lock_);
}

Result<std::unique_ptr<Connection>> Connection::open(const Endpoint& endpoint,
                                                     const LinkTiming& timing) {
  std::unique_ptr<Connection> out(new Connection(endpoint));
  HP_RETURN_IF_ERROR(endpoint.serial ? out->open_serial() : out->open_tcp(timing));
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

Status Connection::open_tcp(const LinkTiming& timing) {
  line_ = connect_socket(endpoint_, timing.connect);
  if (line_ >= 0) return {};
  return offline(endpoint_,
                 std::string(std::strerror(errno)) + ". Check the power and the address");
}

Status Connection::open_serial() {
  // The lock is taken before libmodbus changes settings that another program may be using.
  lock_ = ::open(endpoint_.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (lock_ < 0) return offline(endpoint_, serial_remedy(errno));
  if (::isatty(lock_) == 0) return offline(endpoint_, "not a serial line. Correct the path");
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) return offline(endpoint_, serial_remedy(errno));
  forget_settings(lock_);
  modbus_ = modbus_new_rtu(endpoint_.device.c_str(), endpoint_.baud, endpoint_.parity, 8,
                           endpoint_.stop_bits);
  if (modbus_ == nullptr || modbus_connect(modbus_) != 0) {
    return offline(endpoint_, serial_remedy(errno));
  }
  line_ = modbus_get_socket(modbus_);
  owns_ = ::ioctl(lock_, TIOCEXCL) == 0;
  return {};
}

/// Waits for an event. Returns false if none has occurred by the given time.
bool Connection::wait(short events, TimePoint until) const {
  for (;;) {
    const auto left = std::max(until - Clock::now(), Clock::duration::zero());
    const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(left);
    const timespec limit{static_cast<time_t>(seconds.count()),
                         static_cast<long>(std::chrono::nanoseconds(left - seconds).count())};
    pollfd wanted{line_, events, 0};
    const int ready = ::ppoll(&wanted, 1, &limit, nullptr);
    if (ready >= 0 || errno != EINTR) return ready != 0;
  }
}

// On a serial line, input that is pending may continue, so it is discarded up to a gap.
bool Connection::discard_input() {
  const auto gap = endpoint_.serial ? frame_gap(endpoint_) : std::chrono::nanoseconds(0);
  const auto end = Clock::now() + (endpoint_.serial ? wire_time(endpoint_, kLongestFrame) : gap);
  std::array<std::uint8_t, kChunk> chunk{};
  bool any = false;
  while (::read(line_, chunk.data(), chunk.size()) > 0 ||
         (any && wait(POLLIN, Clock::now() + gap) && Clock::now() < end)) {
    any = true;
  }
  return any;
}

bool Connection::send(const std::vector<std::uint8_t>& bytes, TimePoint until) const {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const void* const rest = bytes.data() + done;
    const std::size_t size = bytes.size() - done;
    const ssize_t sent =
        endpoint_.serial ? ::write(line_, rest, size) : ::send(line_, rest, size, MSG_NOSIGNAL);
    if (sent > 0) {
      done += static_cast<std::size_t>(sent);
    } else if ((errno != EAGAIN && errno != EINTR) || !wait(POLLOUT, until)) {
      return false;
    }
  }
  return true;
}

Connection::End Connection::exchange(ReplyReader& reader, std::chrono::nanoseconds patience,
                                     std::string& cause) {
  const TimePoint end = Clock::now() + patience;
  if (!send(reader.sent(), end)) {
    cause = std::strerror(errno);
    return End::kLost;
  }
  std::array<std::uint8_t, kChunk> chunk{};
  while (wait(POLLIN, end)) {
    const ssize_t got = ::read(line_, chunk.data(), chunk.size());
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (got <= 0) {
      cause = got == 0 ? "closed by the other end" : std::strerror(errno);
      return End::kLost;
    }
    switch (reader.add({chunk.data(), static_cast<std::size_t>(got)})) {
      case ReplyReader::Found::kReply:
        return End::kReply;
      case ReplyReader::Found::kDamaged:
        return End::kDamaged;
      case ReplyReader::Found::kEcho:
        return End::kEcho;
      case ReplyReader::Found::kNothing:
        break;
    }
  }
  return End::kTimeout;
}

}  // namespace hydroprint::drive
