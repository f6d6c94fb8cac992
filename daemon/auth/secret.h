#pragma once

#include <string>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::auth {

/// Makes the library of cryptography ready; before anything else here, once or often.
[[nodiscard]] Status start_cryptography();

/// That many random bytes as hex digits, two each.
[[nodiscard]] std::string random_hex(std::size_t bytes);

/// Whether two texts are equal, in a time that says nothing of where they differ.
[[nodiscard]] bool equal_in_constant_time(std::string_view a, std::string_view b);

/// What a page with this session has to send along with every change (the header of daemon/http):
/// HMAC-SHA-256 of a fixed text with the session's token as key. From it the token cannot be told,
/// and without the token, which no script can read, it cannot be made.
[[nodiscard]] std::string csrf_token(std::string_view session_token);

}  // namespace hydroprint::auth
