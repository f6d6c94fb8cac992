#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "sim/base/result.h"

// All JSON from files, processes and the network is read through this header. Include it in .cpp
// files only.

namespace hydroprint {

struct JsonLimits {
  std::size_t bytes = std::size_t{16} << 20;
  int depth = 64;  ///< maximum nesting of objects and arrays
};

/// Parses untrusted text.
/// @return kInvalidArgument if the text is too long, too deep or not valid JSON (with line and
///     column), or contains a number beyond the range of double
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, JsonLimits limits = {});

/// Same as parse_json(), for a file; errors name the file. Also returns the errors of
/// read_text_file().
[[nodiscard]] Result<nlohmann::json> read_json_file(const std::filesystem::path& path);

/// The value at `key`; null if `object` is not an object or lacks the key.
[[nodiscard]] const nlohmann::json& json_at(const nlohmann::json& object, const char* key);

/// The finite number, string or unsigned integer at `key`; nullopt if the key is missing or its
/// value has another type.
[[nodiscard]] std::optional<double> json_number(const nlohmann::json& object, const char* key);
[[nodiscard]] std::optional<std::string> json_string(const nlohmann::json& object, const char* key);
[[nodiscard]] std::optional<std::uint64_t> json_unsigned(const nlohmann::json& object,
                                                         const char* key);

}  // namespace hydroprint
