#pragma once

#include <filesystem>
#include <string>

#include "sim/base/context.h"
#include "sim/mesh/model.h"

namespace hydroprint::mesh {

/// One reader a format, each in the file of its name. They take the file's bytes, check them and
/// hand them to their importer; what they return has all faces as triangles, indices in range and
/// finite coordinates in the file's units, faces without area still among them.
[[nodiscard]] Result<Model> read_obj(std::string bytes, const std::filesystem::path& path,
                                     const Context& context);
[[nodiscard]] Result<Model> read_stl(std::string bytes, const std::filesystem::path& path,
                                     const Context& context);
[[nodiscard]] Result<Model> read_ply(std::string bytes, const std::filesystem::path& path,
                                     const Context& context);
[[nodiscard]] Result<Model> read_gltf(std::string bytes, const std::filesystem::path& path,
                                      const Context& context);

}  // namespace hydroprint::mesh
