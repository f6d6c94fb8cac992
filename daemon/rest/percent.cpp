#include "daemon/rest/percent.h"

#include <fmt/format.h>

#include <array>
#include <cstdint>

namespace hydroprint::rest {
namespace {

tl::unexpected<Error> refuse(std::string_view text, std::size_t at, const std::string& what) {
  return fail(Code::kInvalidArgument, fmt::format("\"{}\", byte {}: {}", plain(text), at, what),
              ErrorReason::URL_INVALID);
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

bool is_unreserved(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
         c == '_' || c == '.' || c == '~';
}

Result<std::string> decoded(std::string_view text, Keep keep, bool plus_is_blank) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c <= ' ' || c >= 0x7f || c == '#') {
      return refuse(text, i, "this character is not allowed in a URL; encode it as %XX");
    }
    if (c != '%') {
      result += c == '+' && plus_is_blank ? ' ' : c;
      continue;
    }
    const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
    if (high < 0 || low < 0) return refuse(text, i, "% must be followed by two hex digits");
    const char byte = static_cast<char>(high * 16 + low);
    if (byte == 0) return refuse(text, i, "NUL is not allowed");
    if (byte == '/' && keep == Keep::kSlash) {
      result += text.substr(i, 3);
    } else {
      result += byte;
    }
    i += 2;
  }
  if (not_utf8_at(result) != std::string::npos) return refuse(text, 0, "not UTF-8");
  return result;
}

// Length of a UTF-8 character in bytes (0 if it is invalid), and the range of its second byte.
struct Lead {
  std::size_t length;
  std::uint8_t least, most;
};

// Returns the properties of a character from its first byte (table 3-7 of the Unicode standard).
// The table excludes overlong forms, surrogates and code points above U+10FFFF.
Lead lead_of(std::uint8_t byte) {
  if (byte < 0x80) return {1, 0, 0};
  if (byte >= 0xc2 && byte <= 0xdf) return {2, 0x80, 0xbf};
  if (byte == 0xe0) return {3, 0xa0, 0xbf};
  if (byte == 0xed) return {3, 0x80, 0x9f};
  if (byte >= 0xe1 && byte <= 0xef) return {3, 0x80, 0xbf};
  if (byte == 0xf0) return {4, 0x90, 0xbf};
  if (byte >= 0xf1 && byte <= 0xf3) return {4, 0x80, 0xbf};
  if (byte == 0xf4) return {4, 0x80, 0x8f};
  return {0, 0, 0};
}

}  // namespace

std::size_t not_utf8_at(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  for (std::size_t i = 0; i < text.size();) {
    const Lead lead = lead_of(byte(i));
    if (lead.length == 0 || i + lead.length > text.size()) return i;
    if (lead.length > 1 && (byte(i + 1) < lead.least || byte(i + 1) > lead.most)) return i;
    for (std::size_t k = 2; k < lead.length; ++k) {
      if ((byte(i + k) & 0xc0) != 0x80) return i;
    }
    i += lead.length;
  }
  return std::string_view::npos;
}

Result<std::string> decode(std::string_view text, Keep keep) { return decoded(text, keep, false); }

Result<std::string> decode_query(std::string_view text) {
  return decoded(text, Keep::kNothing, true);
}

std::string plain(std::string_view text) {
  std::string result(text.substr(0, 100));
  for (char& c : result) {
    if (c < ' ' || c >= 0x7f || c == '"' || c == '\\') c = '?';
  }
  return text.size() > 100 ? result + "..." : result;
}

std::string encode(std::string_view text) {
  static constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    if (is_unreserved(c)) {
      result += c;
    } else {
      const auto byte = static_cast<std::uint8_t>(c);
      result += {'%', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return result;
}

}  // namespace hydroprint::rest
