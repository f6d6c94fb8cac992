#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hydroprint::calibrate {

/// Bytes as text (RFC 4648, section 4, padded).
[[nodiscard]] std::string base64(std::span<const unsigned char> bytes);

/// The bytes of such a text; nothing if it is none. Never more than the text is long.
[[nodiscard]] std::optional<std::vector<unsigned char>> from_base64(std::string_view text);

}  // namespace hydroprint::calibrate
