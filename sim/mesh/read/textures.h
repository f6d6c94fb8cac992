#pragma once

#include <filesystem>
#include <string>

namespace hydroprint::mesh {

/// Where a texture lies that a model in `folder` names: as named, with backslashes for slashes, or
/// by its bare name beside the model, whichever exists first; as named if none does.
[[nodiscard]] std::filesystem::path resolve_texture(const std::filesystem::path& folder,
                                                    std::string name);

}  // namespace hydroprint::mesh
