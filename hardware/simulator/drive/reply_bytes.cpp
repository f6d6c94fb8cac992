#include "hardware/simulator/drive/reply_bytes.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

namespace hydroprint::simulated_drive {
namespace {

constexpr int kPatience_ms = 1000;
constexpr int kOvertaking = 2;  // replies

/// CRC of Modbus over serial line 2.5.1.2, low byte first on the wire.
std::uint16_t crc(std::span<const std::uint8_t> bytes) {
  std::uint16_t out = 0xffff;
  for (const std::uint8_t byte : bytes) {
    out ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      const bool odd = (out & 1U) != 0;
      out = static_cast<std::uint16_t>(out >> 1U ^ (odd ? 0xa001U : 0U));
    }
  }
  return out;
}

void damage(std::vector<std::uint8_t>& reply, ReplyFaultKind fault) {
  if (fault == ReplyFaultKind::kWrongId) reply[0] ^= 0x01U;
  if (fault == ReplyFaultKind::kWrongFunction) reply[1] ^= 0x07U;
  if (fault != ReplyFaultKind::kWrongLength) return;
  const bool holds_words = (reply[1] == 3 || reply[1] == 4) && reply[2] >= 2;
  if (holds_words) {
    reply[2] = static_cast<std::uint8_t>(reply[2] - 2);
    reply.resize(reply.size() - 2);
  } else {
    reply.back() ^= 0x01U;
  }
}

/// Writes to a socket (without SIGPIPE if it is closed) or to another descriptor.
ssize_t write_some(int descriptor, std::span<const std::uint8_t> bytes) {
  const ssize_t sent = ::send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent >= 0 || errno != ENOTSOCK) return sent;
  return ::write(descriptor, bytes.data(), bytes.size());
}

bool never_comes(ReplyFaultKind fault, const std::vector<std::uint8_t>& reply) {
  return reply.empty() || fault == ReplyFaultKind::kDrop || fault == ReplyFaultKind::kDropRequest;
}

std::vector<std::uint8_t> cut(std::vector<std::uint8_t> frame, ReplyFaultKind fault) {
  if (fault == ReplyFaultKind::kTruncate) frame.resize(frame.size() / 2);
  return frame;
}

}  // namespace

std::vector<std::uint8_t> serial_frame(std::vector<std::uint8_t> reply, ReplyFaultKind fault) {
  if (never_comes(fault, reply)) return {};
  damage(reply, fault);
  const unsigned sum = crc(reply) ^ (fault == ReplyFaultKind::kWrongCrc ? 0x0101U : 0U);
  reply.push_back(static_cast<std::uint8_t>(sum & 0xffU));
  reply.push_back(static_cast<std::uint8_t>(sum >> 8U));
  return cut(std::move(reply), fault);
}

std::vector<std::uint8_t> tcp_frame(std::span<const std::uint8_t> header,
                                    std::vector<std::uint8_t> reply, ReplyFaultKind fault) {
  if (never_comes(fault, reply)) return {};
  damage(reply, fault);
  std::vector<std::uint8_t> out(header.begin(), header.begin() + 4);
  if (fault == ReplyFaultKind::kWrongCrc) out[1] ^= 0x01U;
  out.push_back(static_cast<std::uint8_t>(reply.size() >> 8U));
  out.push_back(static_cast<std::uint8_t>(reply.size() & 0xffU));
  out.insert(out.end(), reply.begin(), reply.end());
  return cut(std::move(out), fault);
}

std::vector<std::uint8_t> OvertakenReply::bytes_for(const std::vector<std::uint8_t>& frame,
                                                    ReplyFaultKind fault) {
  if (fault == ReplyFaultKind::kOvertaken) {
    held_ = frame;
    followers_ = 0;
    return {};
  }
  std::vector<std::uint8_t> out;
  if (!held_.empty() && !frame.empty() && ++followers_ > kOvertaking) held_.swap(out);
  out.insert(out.end(), frame.begin(), frame.end());
  if (fault == ReplyFaultKind::kDouble) out.insert(out.end(), frame.begin(), frame.end());
  return out;
}

void write_all(int descriptor, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = write_some(descriptor, bytes);
    if (done > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(done));
      continue;
    }
    pollfd wait{descriptor, POLLOUT, 0};
    const bool may_go_on = done < 0 && (errno == EAGAIN || errno == EINTR);
    if (!may_go_on || ::poll(&wait, 1, kPatience_ms) <= 0) return;
  }
}

}  // namespace hydroprint::simulated_drive
