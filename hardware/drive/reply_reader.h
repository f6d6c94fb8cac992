#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hardware/drive/frame.h"
#include "hardware/drive/pdu.h"
#include "sim/base/result.h"

namespace hydroprint::drive {

/// Finds the reply to one request in the bytes that arrive after it, which are untrusted. Other
/// bytes and the replies to other requests are passed over.
class ReplyReader {
 public:
  /// @param transaction  id of the request; a TCP frame with another id is another reply
  ReplyReader(Request request, std::uint16_t transaction, Framing framing, const BusVariant& bus);

  /// Returns the frame to send.
  [[nodiscard]] const std::vector<std::uint8_t>& sent() const { return sent_; }

  enum class Found {
    kNothing,  ///< more bytes are needed
    kReply,    ///< reply() has a value
    kDamaged,  ///< the reply has arrived with a wrong checksum
    kEcho,     ///< the request itself has arrived, and BusVariant::echo is not set
  };
  [[nodiscard]] Found add(std::span<const std::uint8_t> bytes);

  /// The result of decode_reply, except REPLY_INVALID.
  [[nodiscard]] const std::optional<Result<std::vector<std::uint16_t>>>& reply() const {
    return reply_;
  }

  /// Returns the number of whole replies that belong to other requests.
  [[nodiscard]] std::uint64_t others() const { return others_; }

  /// Returns whether bytes follow the reply.
  [[nodiscard]] bool has_more() const { return reply_ && has_more_; }

  /// Returns why the bytes received so far contain no reply, with the remedy; empty if nothing but
  /// silence or a part of a frame is the cause.
  [[nodiscard]] std::string trouble() const;

 private:
  [[nodiscard]] Found look();
  [[nodiscard]] bool take_echo();
  [[nodiscard]] bool take_reply(const ReplyFrame& frame, std::size_t at);
  [[nodiscard]] Found look_further();
  [[nodiscard]] bool is_ours(std::span<const std::uint8_t> reply) const;

  Request request_;
  std::uint16_t transaction_;
  Framing framing_;
  BusVariant bus_;
  std::vector<std::uint8_t> sent_;
  std::vector<std::uint8_t> received_;
  bool awaits_echo_;
  std::optional<Result<std::vector<std::uint16_t>>> reply_;
  bool has_more_ = false;
  std::uint64_t others_ = 0;
  std::string other_;  // why the last of them is not the reply
};

}  // namespace hydroprint::drive
