#pragma once

#include <filesystem>
#include <string_view>

#include "sim/base/result.h"

namespace hydroprint::mesh {

/// Checks a glTF file's JSON before the importer sees it, because the importer accepts any nesting
/// and any image offset. Rejects invalid JSON, nesting deeper than 64, images that lie outside
/// their buffers, and compressed meshes.
/// @param bytes  the whole file, .gltf or .glb
[[nodiscard]] Status check_gltf(std::string_view bytes, const std::filesystem::path& path);

}  // namespace hydroprint::mesh
