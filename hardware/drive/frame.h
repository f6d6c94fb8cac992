#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hydroprint::drive {

/// Set in the function of a reply that rejects the request.
inline constexpr std::uint8_t kExceptionFlag = 0x80;

/// Appends a word, high byte first.
inline void put_word(std::vector<std::uint8_t>& out, std::size_t word) {
  out.push_back(static_cast<std::uint8_t>(word >> 8U & 0xffU));
  out.push_back(static_cast<std::uint8_t>(word & 0xffU));
}

/// Returns the word at an index of bytes.
[[nodiscard]] inline std::uint16_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8U | bytes[at + 1]);
}

/// How requests and replies are framed. RTU frames end with a checksum. TCP frames begin with a
/// header, which holds the transaction id and the length.
enum class Framing { kRtu, kTcp };

/// Returns the checksum of RTU frames, which is sent low byte first (Modbus over serial line
/// 2.5.1.2).
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes);

/// Returns the frame of a request: unit, function and data. RTU has no transaction ids.
[[nodiscard]] std::vector<std::uint8_t> frame_of(Framing framing, std::uint16_t transaction,
                                                 std::span<const std::uint8_t> request);

/// What received bytes, which are untrusted, begin with.
struct ReplyFrame {
  enum class Kind {
    kNone,        ///< not a frame of one of the functions that are used with drives
    kIncomplete,  ///< perhaps the beginning of a frame
    kDamaged,     ///< as many bytes as the frame has, with the wrong checksum
    kWhole,
  };
  Kind kind = Kind::kNone;
  std::size_t bytes = 0;                ///< length of a whole frame
  std::uint16_t transaction = 0;        ///< TCP only
  std::span<const std::uint8_t> reply;  ///< unit, function and data of a whole or damaged frame
};

/// Examines the first bytes of `received`; the result refers to them.
[[nodiscard]] ReplyFrame first_frame(Framing framing, std::span<const std::uint8_t> received);

}  // namespace hydroprint::drive
