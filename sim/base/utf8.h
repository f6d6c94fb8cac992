#pragma once

#include <string>
#include <string_view>

namespace hydroprint {

/// The replacement character, for bytes that are not UTF-8 and characters that cannot be drawn.
inline constexpr char32_t kReplacement = 0xFFFD;

/// Decodes UTF-8. Each malformed sequence becomes one U+FFFD, split as the Unicode Standard
/// recommends (section 3.9, maximal subparts). Each control character becomes U+FFFD as well.
[[nodiscard]] std::u32string decode_utf8(std::string_view text);

/// Encodes code points as UTF-8; surrogates and numbers above U+10FFFF become U+FFFD.
[[nodiscard]] std::string encode_utf8(std::u32string_view text);

/// Replaces each malformed sequence and each control character by U+FFFD.
[[nodiscard]] std::string valid_utf8(std::string_view text);

/// Puts the text on one line of valid UTF-8: control characters, including line ends, become
/// blanks, and bytes that are not UTF-8 become U+FFFD. For messages that quote untrusted files or
/// input.
[[nodiscard]] std::string one_line(std::string text);

}  // namespace hydroprint
