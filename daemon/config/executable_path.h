#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::daemon {

/// Returns the path of the running program: the target of `link`. Without /proc, resolves `argv0`,
/// which is a path, or a name that is looked up in `search_path` as a shell does. Empty if no file
/// is found. Call this before the working directory changes.
[[nodiscard]] std::filesystem::path own_program(
    const std::string& argv0, const std::string& search_path,
    const std::filesystem::path& link = "/proc/self/exe");

}  // namespace hydroprint::daemon
