#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "sim/base/result.h"

namespace hydroprint {

/// Reads a JSON file of at most 16 MiB. For inclusion in .cpp files only.
/// Refuses what read_text_file refuses, and with kInvalidArgument what is no JSON, naming line and
/// column.
[[nodiscard]] Result<nlohmann::json> read_json_file(const std::filesystem::path& path);

}  // namespace hydroprint
