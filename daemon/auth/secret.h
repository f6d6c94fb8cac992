#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::auth {

/// Initialises the cryptographic library. Call this before anything else here; it may be called
/// again.
[[nodiscard]] Status start_cryptography();

/// `bytes` random bytes as hex digits.
[[nodiscard]] std::string random_hex(std::size_t bytes);

/// Compares two texts in a time that does not depend on where they differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b);

/// The token that a page must send with every change in its session (see the header in
/// daemon/http). It is HMAC-SHA-256 of a fixed text with the session token as key. It does not
/// reveal the session token, and cannot be computed without that token, which scripts cannot read.
[[nodiscard]] std::string csrf_token(std::string_view session_token);

}  // namespace hydroprint::auth
