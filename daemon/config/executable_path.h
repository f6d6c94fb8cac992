#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::daemon {

/// Returns the file of the running program: the target of `link` or, without /proc, argv[0] as a
/// path or a name that is searched for in `search_path` as in the shell. Empty if no file is found.
/// Call it before the working directory changes.
[[nodiscard]] std::filesystem::path own_program(
    const std::string& argv0, const std::string& search_path,
    const std::filesystem::path& link = "/proc/self/exe");

}  // namespace hydroprint::daemon
