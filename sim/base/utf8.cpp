#include "sim/base/utf8.h"

#include <algorithm>

namespace hydroprint {
namespace {

/// The sequence that a first byte announces. Only the range of the second byte depends on the
/// first.
struct Sequence {
  int continuation_bytes = 0;
  char32_t first_bits = 0;
  unsigned low = 0x80, high = 0xBF;  ///< range of the second byte
  bool is_valid = true;
};

Sequence sequence_of(unsigned char first) {
  if (first < 0x80) return {0, first};
  if (first >= 0xC2 && first <= 0xDF) return {1, static_cast<char32_t>(first & 0x1F)};
  if (first >= 0xE0 && first <= 0xEF) {
    return {2, static_cast<char32_t>(first & 0x0F), first == 0xE0 ? 0xA0U : 0x80U,
            first == 0xED ? 0x9FU : 0xBFU};
  }
  if (first >= 0xF0 && first <= 0xF4) {
    return {3, static_cast<char32_t>(first & 0x07), first == 0xF0 ? 0x90U : 0x80U,
            first == 0xF4 ? 0x8FU : 0xBFU};
  }
  return {0, 0, 0, 0, false};
}

bool is_control(char32_t c) { return c < 0x20 || (c >= 0x7F && c < 0xA0); }

/// Decodes the sequence at `at` and moves `at` past it, or past its well-formed beginning.
char32_t decode_one(std::string_view text, std::size_t& at) {
  const auto byte_at = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const Sequence sequence = sequence_of(byte_at(at++));
  if (!sequence.is_valid) return kReplacement;
  char32_t out = sequence.first_bits;
  for (int i = 0; i < sequence.continuation_bytes; ++i) {
    const unsigned low = i == 0 ? sequence.low : 0x80U, high = i == 0 ? sequence.high : 0xBFU;
    if (at == text.size() || byte_at(at) < low || byte_at(at) > high) return kReplacement;
    out = out << 6 | static_cast<char32_t>(byte_at(at++) & 0x3F);
  }
  return is_control(out) ? kReplacement : out;
}

}  // namespace

std::u32string decode_utf8(std::string_view text) {
  std::u32string out;
  for (std::size_t at = 0; at < text.size();) out += decode_one(text, at);
  return out;
}

std::string encode_utf8(std::u32string_view text) {
  std::string out;
  for (char32_t c : text) {
    if (c > 0x10FFFF || (c >= 0xD800 && c < 0xE000)) c = kReplacement;
    const auto continuation = [&](int shift) {
      out += static_cast<char>(0x80 | (c >> shift & 0x3F));
    };
    if (c < 0x80) {
      out += static_cast<char>(c);
    } else if (c < 0x800) {
      out += static_cast<char>(0xC0 | c >> 6);
      continuation(0);
    } else if (c < 0x10000) {
      out += static_cast<char>(0xE0 | c >> 12);
      continuation(6);
      continuation(0);
    } else {
      out += static_cast<char>(0xF0 | c >> 18);
      continuation(12);
      continuation(6);
      continuation(0);
    }
  }
  return out;
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return encode_utf8(decode_utf8(text));
}

std::string valid_utf8(std::string_view text) { return encode_utf8(decode_utf8(text)); }

}  // namespace hydroprint
