#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace hydroprint::cli {

/// Returns the full name of a command, for example "hydroprint submit simulate".
[[nodiscard]] std::string full_name(const CLI::App& app);

/// Explains wrong usage in one line. For an unknown command or flag, names it and the nearest one
/// that exists.
[[nodiscard]] std::string usage_error(const CLI::App* app, const CLI::Error& error);

/// Returns the flag of the chosen command for a field of a request: "--dpi" for "simulate.dpi"; the
/// path itself if there is no such flag.
[[nodiscard]] std::string word_of_field(const CLI::App& app, const std::string& field);

}  // namespace hydroprint::cli
