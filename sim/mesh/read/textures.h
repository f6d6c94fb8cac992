#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::mesh {

/// The path of a texture named by a model in `folder`. Candidates are the name itself, the name
/// with slashes for backslashes, and its bare file name beside the model. Returns the first that
/// exists, else the name itself.
[[nodiscard]] std::filesystem::path resolve_texture(const std::filesystem::path& folder,
                                                    std::string name);

}  // namespace hydroprint::mesh
