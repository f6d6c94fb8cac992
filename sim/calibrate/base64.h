#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hydroprint::calibrate {

/// Encodes bytes as base64 (RFC 4648, section 4, padded).
[[nodiscard]] std::string base64(std::span<const unsigned char> bytes);

/// Decodes base64; nullopt if it is malformed. The result is never longer than the text.
[[nodiscard]] std::optional<std::vector<unsigned char>> from_base64(std::string_view text);

}  // namespace hydroprint::calibrate
