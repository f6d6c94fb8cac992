#include "sim/calibrate/base64.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace hydroprint::calibrate {
namespace {

constexpr std::string_view kLetters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr char kPad = '=';
constexpr std::size_t kBytes = 3, kChars = 4;

}  // namespace

std::string base64(std::span<const unsigned char> bytes) {
  std::string out;
  out.reserve((bytes.size() + kBytes - 1) / kBytes * kChars);
  for (std::size_t i = 0; i < bytes.size(); i += kBytes) {
    const std::size_t here = std::min(kBytes, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < kBytes; ++k)
      word = word << 8U | (k < here ? bytes[i + k] : std::uint32_t{0});
    for (std::size_t k = 0; k < kChars; ++k)
      out += k <= here ? kLetters[word >> (18U - 6U * k) & 63U] : kPad;
  }
  return out;
}

std::optional<std::vector<unsigned char>> from_base64(std::string_view text) {
  if (text.size() % kChars != 0) return {};
  std::size_t pads = 0;
  while (pads < 2 && pads < text.size() && text[text.size() - 1 - pads] == kPad) ++pads;
  std::vector<unsigned char> out;
  out.reserve(text.size() / kChars * kBytes);
  for (std::size_t i = 0; i < text.size(); i += kChars) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < kChars; ++k) {
      const bool is_pad = i + k >= text.size() - pads;
      const std::size_t six = is_pad ? 0 : kLetters.find(text[i + k]);
      if (six == std::string_view::npos) return {};
      word = word << 6U | static_cast<std::uint32_t>(six);
    }
    for (std::size_t k = 0; k < kBytes; ++k)
      out.push_back(static_cast<unsigned char>(word >> (16U - 8U * k) & 255U));
  }
  out.resize(out.size() - pads);
  return out;
}

}  // namespace hydroprint::calibrate
