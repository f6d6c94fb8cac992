#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// What decode() leaves alone.
enum class Keep {
  kNothing,  ///< "%2F" becomes "/"
  kSlash,    ///< "%2F" and "%2f" stay as they are
};

/// Percent-decodes part of a URL. Refused (kInvalidArgument, URL_INVALID, with the place in
/// `text`):
/// "%" without two hex digits, characters that a URL cannot have, and what then holds NUL or is not
/// UTF-8 (overlong forms and surrogates are not).
[[nodiscard]] Result<std::string> decode(std::string_view text, Keep keep = Keep::kNothing);

/// The same, and "+" is a blank, as forms have it.
[[nodiscard]] Result<std::string> decode_query(std::string_view text);

/// Percent-encodes all but letters, digits and "-_.~".
[[nodiscard]] std::string encode(std::string_view text);

/// A stranger's text as a message may show it: printable ASCII, "?" for the rest, 100 bytes at
/// most.
[[nodiscard]] std::string plain(std::string_view text);

/// Byte at which `text` stops being UTF-8; npos: it does not.
[[nodiscard]] std::size_t not_utf8_at(std::string_view text);

}  // namespace hydroprint::rest
