#include "hardware/drive/frame.h"

namespace hydroprint::drive {
namespace {

using Kind = ReplyFrame::Kind;
using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kCrc = 2;
constexpr std::size_t kHeader = 6;  // bytes before the unit id
constexpr std::size_t kLeastReply = 3;
constexpr std::size_t kMostReply = 254;
constexpr std::size_t kConfirmation = 6;  // length of the reply to a write

bool is_used(std::uint8_t function) {
  return function == 3 || function == 4 || function == 6 || function == 16;
}

/// Returns the length of unit, function and data from the first three bytes; 0 if they do not begin
/// a reply.
std::size_t reply_length(Bytes first) {
  const std::uint8_t function = first[1];
  if (is_used(function & static_cast<std::uint8_t>(~kExceptionFlag)) &&
      (function & kExceptionFlag) != 0) {
    return kLeastReply;
  }
  if (!is_used(function)) return 0;
  if (function > 4) return kConfirmation;
  const std::size_t bytes = first[2];
  return bytes > 0 && bytes % 2 == 0 && kLeastReply + bytes <= kMostReply ? kLeastReply + bytes : 0;
}

ReplyFrame first_rtu(Bytes received) {
  if (received.size() < kLeastReply) return {Kind::kIncomplete, 0, 0, {}};
  const std::size_t length = reply_length(received);
  if (length == 0) return {};
  if (received.size() < length + kCrc) return {Kind::kIncomplete, 0, 0, {}};
  const Bytes reply = received.first(length);
  const unsigned sum = received[length] | static_cast<unsigned>(received[length + 1]) << 8U;
  return {crc16(reply) == sum ? Kind::kWhole : Kind::kDamaged, length + kCrc, 0, reply};
}

ReplyFrame first_tcp(Bytes received) {
  if (received.size() < kHeader) return {Kind::kIncomplete, 0, 0, {}};
  const std::size_t length = word_at(received, 4);
  if (word_at(received, 2) != 0 || length < kLeastReply || length > kMostReply) return {};
  if (received.size() < kHeader + length) return {Kind::kIncomplete, 0, 0, {}};
  return {Kind::kWhole, kHeader + length, word_at(received, 0), received.subspan(kHeader, length)};
}

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  unsigned out = 0xffff;
  for (const std::uint8_t byte : bytes) {
    out ^= byte;
    for (int bit = 0; bit < 8; ++bit) out = out >> 1U ^ (out % 2 == 1 ? 0xa001U : 0U);
  }
  return static_cast<std::uint16_t>(out);
}

std::vector<std::uint8_t> frame_of(Framing framing, std::uint16_t transaction,
                                   std::span<const std::uint8_t> request) {
  std::vector<std::uint8_t> out;
  if (framing == Framing::kTcp) {
    put_word(out, transaction);
    put_word(out, 0);
    put_word(out, request.size());
  }
  out.insert(out.end(), request.begin(), request.end());
  if (framing == Framing::kRtu) {
    const std::uint16_t sum = crc16(request);
    put_word(out, static_cast<std::size_t>(sum % 256) << 8U | sum / 256);
  }
  return out;
}

ReplyFrame first_frame(Framing framing, std::span<const std::uint8_t> received) {
  return framing == Framing::kRtu ? first_rtu(received) : first_tcp(received);
}

}  // namespace hydroprint::drive
