#include "hardware/drive/reply_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace hydroprint::drive {
namespace {

using Input = std::span<const std::uint8_t>;

std::string unit_trouble(int unit, int expected) {
  return fmt::format(
      "a reply comes from unit {} instead of {}. If a gateway replies for the drive, set "
      "unit_any = true in the profile; otherwise correct unit",
      unit, expected);
}

}  // namespace

ReplyReader::ReplyReader(Request request, std::uint16_t transaction, Framing framing,
                         const BusVariant& bus)
    : request_(std::move(request)),
      transaction_(transaction),
      framing_(framing),
      bus_(bus),
      sent_(frame_of(framing, transaction, encode_request(request_))),
      awaits_echo_(bus.echo) {}

ReplyReader::Found ReplyReader::add(std::span<const std::uint8_t> bytes) {
  received_.insert(received_.end(), bytes.begin(), bytes.end());
  if (awaits_echo_ && !take_echo()) return Found::kNothing;
  return look();
}

/// Removes the echo and what precedes it; false if it is not complete.
bool ReplyReader::take_echo() {
  const auto echo = std::search(received_.begin(), received_.end(), sent_.begin(), sent_.end());
  if (echo == received_.end()) return false;
  received_.erase(received_.begin(), echo + static_cast<std::ptrdiff_t>(sent_.size()));
  awaits_echo_ = false;
  return true;
}

bool ReplyReader::is_ours(Input reply) const {
  const auto function = static_cast<std::uint8_t>(request_.function);
  return (bus_.unit_any || reply[0] == request_.unit) &&
         (reply[1] == function || reply[1] == (function | kExceptionFlag));
}

/// Stores the reply that begins at an index of the bytes, or why the frame there is not the reply.
bool ReplyReader::take_reply(const ReplyFrame& frame, std::size_t at) {
  if (framing_ == Framing::kTcp && frame.transaction != transaction_) {
    other_ = "the reply has another transaction id. Check the gateway";
    return false;
  }
  if (frame.reply[0] != request_.unit && !bus_.unit_any) {
    other_ = unit_trouble(frame.reply[0], request_.unit);
    return false;
  }
  std::vector<std::uint8_t> reply(frame.reply.begin(), frame.reply.end());
  reply[0] = static_cast<std::uint8_t>(request_.unit);
  auto words = decode_reply(request_, reply);
  if (!words && words.error().reason == ErrorReason::REPLY_INVALID) {
    other_ = words.error().message;
    return false;
  }
  reply_ = std::move(words);
  has_more_ = at + frame.bytes < received_.size();
  return true;
}

// A write's reply may equal its request, so only the echo of a read is recognised. Every connection
// begins with reads.
ReplyReader::Found ReplyReader::look() {
  for (;;) {
    const ReplyFrame frame = first_frame(framing_, received_);
    if (frame.kind == ReplyFrame::Kind::kWhole) {
      if (take_reply(frame, 0)) return Found::kReply;
      ++others_;
      received_.erase(received_.begin(),
                      received_.begin() + static_cast<std::ptrdiff_t>(frame.bytes));
      continue;
    }
    if (is_read(request_) && !bus_.echo) {
      const std::size_t common = std::min(received_.size(), sent_.size());
      if (std::equal(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(common),
                     sent_.begin())) {
        return common == sent_.size() ? Found::kEcho : Found::kNothing;
      }
    }
    if (frame.kind == ReplyFrame::Kind::kDamaged && is_ours(frame.reply)) return Found::kDamaged;
    return look_further();
  }
}

/// Looks for the reply after bytes that belong to no frame, such as noise.
ReplyReader::Found ReplyReader::look_further() {
  for (std::size_t i = 1; i < received_.size(); ++i) {
    const ReplyFrame frame = first_frame(framing_, Input(received_).subspan(i));
    if (frame.kind == ReplyFrame::Kind::kWhole && is_ours(frame.reply) && take_reply(frame, i))
      return Found::kReply;
  }
  return Found::kNothing;
}

std::string ReplyReader::trouble() const {
  if (awaits_echo_ && first_frame(framing_, received_).kind == ReplyFrame::Kind::kWhole) {
    return "the adapter does not send requests back. Remove echo = true from the profile";
  }
  const bool is_rtu = framing_ == Framing::kTcp &&
                      first_frame(Framing::kRtu, received_).kind == ReplyFrame::Kind::kWhole;
  if (is_rtu) return "the gateway sends RTU frames. Set rtu_over_tcp = true in the profile";
  if (!received_.empty() && first_frame(framing_, received_).kind == ReplyFrame::Kind::kNone) {
    return invalid_reply("is not a Modbus frame").message;
  }
  return other_;
}

}  // namespace hydroprint::drive
