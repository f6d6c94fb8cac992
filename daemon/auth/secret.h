#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::auth {

/// Initialises the cryptographic library. Must be called before the other functions of this header;
/// may be called again.
[[nodiscard]] Status start_cryptography();

/// Returns `bytes` random bytes as hex digits.
[[nodiscard]] std::string random_hex(std::size_t bytes);

/// Compares two texts in a time that does not depend on where they differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b);

/// Returns the token that a page must send with every change in its session (see check_csrf() in
/// daemon/http): the HMAC-SHA-256 of a fixed text with the session token as key. It does not reveal
/// the session token, and cannot be computed without it. Scripts cannot read the session token.
[[nodiscard]] std::string csrf_token(std::string_view session_token);

}  // namespace hydroprint::auth
