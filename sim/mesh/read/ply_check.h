#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sim/base/context.h"

namespace hydroprint::mesh {

/// Facts about a PLY file, collected while checking it.
struct PlyFacts {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::string texture;        ///< from a line `comment TextureFile NAME`
  bool has_face_uvs = false;  ///< texture coordinates listed per face
};

/// Checks a PLY file from its header to its last byte, because the importer trusts every count and
/// reads past the end. Rejects headers with wrong counts, truncated files, malformed or non-finite
/// numbers, faces with fewer than three corners, and indices out of range. Errors name the vertex
/// or face.
[[nodiscard]] Result<PlyFacts> check_ply(std::string_view bytes, const std::filesystem::path& path,
                                         const Context& context);

}  // namespace hydroprint::mesh
