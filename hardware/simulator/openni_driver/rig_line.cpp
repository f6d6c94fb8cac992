#include "hardware/simulator/openni_driver/rig_line.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace hydroprint::openni_driver {
namespace {

constexpr timeval kPatience{1, 0};
constexpr std::string_view kRefusal = "error: ";

tl::unexpected<Error> gone() {
  return fail(Code::kUnavailable, "the virtual rig has stopped. Start it again");
}

tl::unexpected<Error> nobody_at(const std::string& path) {
  return fail(
      Code::kUnavailable,
      fmt::format("no virtual rig listens at {0}. Start hydroprint-virtual-rig with --control {0}",
                  path));
}

}  // namespace

Result<RigLine> RigLine::connect(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) return nobody_at(path);
  std::memcpy(address.sun_path, path.c_str(), path.size());
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return nobody_at(path);
  RigLine out(descriptor);
  ::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
  ::setsockopt(descriptor, SOL_SOCKET, SO_SNDTIMEO, &kPatience, sizeof kPatience);
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return nobody_at(path);
  }
  return out;
}

RigLine::RigLine(RigLine&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      is_reply_pending_(other.is_reply_pending_),
      buffer_(std::move(other.buffer_)) {}

RigLine::~RigLine() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<std::string> RigLine::ask(const std::string& line) {
  const std::string text = line + "\n";
  if (!is_reply_pending_ && ::send(descriptor_, text.data(), text.size(), MSG_NOSIGNAL) !=
                                static_cast<ssize_t>(text.size())) {
    return gone();
  }
  is_reply_pending_ = true;
  std::array<char, 65536> chunk;
  for (;;) {
    if (const auto end = buffer_.find('\n'); end != std::string::npos) {
      std::string reply = buffer_.substr(0, end);
      buffer_.erase(0, end + 1);
      is_reply_pending_ = false;
      if (!reply.starts_with(kRefusal)) return reply;
      return fail(Code::kFailedPrecondition, reply.substr(kRefusal.size()));
    }
    const ssize_t got = ::recv(descriptor_, chunk.data(), chunk.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) {
      return fail(Code::kAborted,
                  "the virtual rig does not respond. Check whether it is suspended");
    }
    if (got <= 0) return gone();
    buffer_.append(chunk.data(), static_cast<std::size_t>(got));
  }
}

Result<std::string> RigLine::ask_until_deadline(const std::string& line) {
  constexpr int kTimes = 30;
  auto reply = ask(line);
  for (int i = 1; i < kTimes && !reply && reply.error().code == Code::kAborted; ++i) {
    reply = ask(line);
  }
  return reply;
}

}  // namespace hydroprint::openni_driver
