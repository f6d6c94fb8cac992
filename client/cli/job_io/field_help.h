#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace hydroprint::cli {

// These functions read the rules that the .proto files declare for the field behind a flag, for
// example "SimulateSpec.dpi".

/// Returns the field's help text (rules::flag_help()): "Resolution of the film image (from 20 to
/// 2400 dots per inch; default 300)".
[[nodiscard]] std::string field_help(const std::string& field);

/// Returns a validator that accepts numbers in the field's range.
[[nodiscard]] CLI::Validator field_range(const std::string& field);

}  // namespace hydroprint::cli
