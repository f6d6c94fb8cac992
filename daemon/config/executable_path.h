#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::daemon {

/// Returns the path of a program, without links. `name` is a path, or a name that is looked up in
/// `search_path` as a shell does. Empty if no executable file is found.
[[nodiscard]] std::filesystem::path find_program(const std::string& name,
                                                 const std::string& search_path);

/// Returns the path of the running program: the target of `link`. Without /proc, resolves `argv0`
/// as find_program() does. Call this before the working directory changes.
[[nodiscard]] std::filesystem::path own_program(
    const std::string& argv0, const std::string& search_path,
    const std::filesystem::path& link = "/proc/self/exe");

}  // namespace hydroprint::daemon
