#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hardware/drive/pdu.h"

namespace hydroprint::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// The kind of an input of fuzz_drive, selected by its first byte (modulo the number of kinds).
enum class Kind : std::uint8_t {
  kExchange,  ///< one request and any reply
  kPoll,      ///< any reply to each request of a poll
  kNumber,    ///< a format, a value and two words
};
inline constexpr std::uint8_t kKinds = 3;

/// A request and its reply: unit, function and data.
struct Exchange {
  drive::Request request;
  Bytes reply;
};

/// Encodes an exchange as an input. For written words it keeps only their number and the first one,
/// because the reply to a write repeats nothing else.
[[nodiscard]] Bytes input_of(const Exchange& exchange);
/// Encodes the replies to a poll with the profile of this number as an input.
[[nodiscard]] Bytes input_of(std::uint8_t profile, const std::vector<Bytes>& replies);

/// Decodes an input whose first byte, the kind, is already removed; missing bytes are 0.
[[nodiscard]] Exchange exchange_of(std::span<const std::uint8_t> input);
/// Removes the next reply from the input and returns it.
[[nodiscard]] Bytes next_reply(std::span<const std::uint8_t>& input);

}  // namespace hydroprint::fuzz
