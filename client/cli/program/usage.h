#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace hydroprint::cli {

/// Returns a command with its parents, for example "hydroprint submit simulate".
[[nodiscard]] std::string full_name(const CLI::App& app);

/// Explains wrong usage in one line. An unknown command or flag is named, with the nearest one that
/// exists.
[[nodiscard]] std::string usage_error(const CLI::App* app, const CLI::Error& error);

}  // namespace hydroprint::cli
