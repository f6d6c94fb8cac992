#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::rest {

/// The escapes that decode() does not decode.
enum class Keep {
  kNothing,  ///< "%2F" becomes "/"
  kSlash,    ///< "%2F" and "%2f" stay encoded
};

/// Percent-decodes part of a URL. Returns kInvalidArgument, URL_INVALID, with the place in
/// `text`, for:
/// - "%" without two hex digits;
/// - characters that are not allowed in a URL;
/// - decoded text that contains NUL or is not valid UTF-8 (overlong forms and surrogates are not
///   valid).
[[nodiscard]] Result<std::string> decode(std::string_view text, Keep keep = Keep::kNothing);

/// Same as decode(), but "+" is a space, as in HTML forms.
[[nodiscard]] Result<std::string> decode_query(std::string_view text);

/// Percent-encodes everything except letters, digits and "-_.~".
[[nodiscard]] std::string encode(std::string_view text);

/// Makes untrusted text safe for a message: printable ASCII, "?" for other bytes, at most 100
/// bytes.
[[nodiscard]] std::string plain(std::string_view text);

/// Returns the index of the first byte that is not valid UTF-8; npos if the text is valid.
[[nodiscard]] std::size_t not_utf8_at(std::string_view text);

}  // namespace hydroprint::rest
