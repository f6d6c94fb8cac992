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

}  // namespace hydroprint::drive
