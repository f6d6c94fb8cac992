#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::daemon {

/// The file that this program runs from: where `link` points or, where there is no /proc, what
/// argv[0] names, a path or a name to be found in `search_path` as the shell found it. Empty if
/// none of them leads to a file. To be asked before the working folder changes.
[[nodiscard]] std::filesystem::path own_program(
    const std::string& argv0, const std::string& search_path,
    const std::filesystem::path& link = "/proc/self/exe");

}  // namespace hydroprint::daemon
