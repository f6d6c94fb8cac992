#pragma once

#include <filesystem>
#include <string>

#include "sim/base/context.h"
#include "sim/mesh/model.h"

namespace hydroprint::mesh {

/// One reader for each format, each in a file of the same name. Each reader checks the bytes of the
/// file and passes them to the importer. The returned model has only triangles, indices in range
/// and finite coordinates in the file's units; it still contains faces without area.
[[nodiscard]] Result<Model> read_obj(std::string bytes, const std::filesystem::path& path,
                                     const Context& context);
[[nodiscard]] Result<Model> read_stl(std::string bytes, const std::filesystem::path& path,
                                     const Context& context);
[[nodiscard]] Result<Model> read_ply(std::string bytes, const std::filesystem::path& path,
                                     const Context& context);
[[nodiscard]] Result<Model> read_gltf(std::string bytes, const std::filesystem::path& path,
                                      const Context& context);

}  // namespace hydroprint::mesh
