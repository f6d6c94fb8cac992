#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::mesh {

/// Finds the path of a texture named by a model in `folder`. Candidates are the name itself, the
/// name with slashes for backslashes, and its bare file name in the model's folder. Returns the
/// first that exists, else the name itself.
[[nodiscard]] std::filesystem::path resolve_texture(const std::filesystem::path& folder,
                                                    std::string name);

}  // namespace hydroprint::mesh
