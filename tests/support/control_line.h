#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::testing {

/// Sends lines to a control socket of hydroprint-virtual-rig, as soon as there is one; what comes
/// back.
std::string talk(const std::filesystem::path& path, const std::string& lines);

}  // namespace hydroprint::testing
