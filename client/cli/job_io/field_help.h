#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace hydroprint::cli {

// These functions read what the .proto files declare for the field behind a flag, for example
// "SimulateSpec.dpi".

/// Adds the field's range, choices and default to a help text: "Resolution (from 20 to 2400 dots
/// per inch; default 300)".
[[nodiscard]] std::string field_help(const std::string& field, const std::string& text);

/// Accepts numbers in the field's range.
[[nodiscard]] CLI::Validator field_range(const std::string& field);

/// Accepts the field's choices.
[[nodiscard]] CLI::Validator field_choices(const std::string& field);

}  // namespace hydroprint::cli
