#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hardware/drive/pdu.h"

namespace hydroprint::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// What the first byte of an input of fuzz_drive chooses (of the others, the rest of the division).
enum class Kind : std::uint8_t {
  kExchange,  ///< one request and something that came back
  kPoll,      ///< something that came back to each request of a poll
  kNumber,    ///< a format, a value and two words
};
inline constexpr std::uint8_t kKinds = 3;

/// A request and what came back: unit, function and data.
struct Exchange {
  drive::Request request;
  Bytes reply;
};

/// The input that stands for an exchange. Of words that are written it keeps how many there are and
/// the first, which is all that a reply repeats.
[[nodiscard]] Bytes input_of(const Exchange& exchange);
/// The input that stands for these replies to a poll by the profile of this number.
[[nodiscard]] Bytes input_of(std::uint8_t profile, const std::vector<Bytes>& replies);

/// What an input stands for, without its first byte; missing bytes are 0.
[[nodiscard]] Exchange exchange_of(std::span<const std::uint8_t> input);
/// The next reply, which is taken off the input.
[[nodiscard]] Bytes next_reply(std::span<const std::uint8_t>& input);

}  // namespace hydroprint::fuzz
