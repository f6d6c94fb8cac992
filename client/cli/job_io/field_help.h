#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace hydroprint::cli {

// What the .proto files declare of the field that a flag sets, by its name: "SimulateSpec.dpi".

/// A help text with the field's range, choices and default: "Resolution (from 20 to 2400 dots per
/// inch; default 300)".
[[nodiscard]] std::string field_help(const std::string& field, const std::string& text);

/// Accepts the numbers of the field's range.
[[nodiscard]] CLI::Validator field_range(const std::string& field);

/// Accepts the field's choices.
[[nodiscard]] CLI::Validator field_choices(const std::string& field);

}  // namespace hydroprint::cli
