#pragma once

#include <filesystem>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::mesh {

/// Looks over a glTF file's JSON before the importer sees it, since that follows nesting and image
/// offsets wherever they lead. Refuses what is no JSON, nesting deeper than 64, images
/// that lie outside their buffers, compressed meshes.
/// @param bytes  the whole file, .gltf or .glb
[[nodiscard]] Status check_gltf(std::string_view bytes, const std::filesystem::path& path);

}  // namespace hydroprint::mesh
