#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::testing {

/// Waits for the control socket of hydroprint-virtual-rig, sends lines to it, and returns the
/// response.
std::string talk(const std::filesystem::path& path, const std::string& lines);

}  // namespace hydroprint::testing
