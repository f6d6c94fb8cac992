#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sim/base/context.h"

namespace hydroprint::mesh {

/// Facts collected by the check of a PLY file.
struct PlyFacts {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::string texture;        ///< of a `comment TextureFile NAME` line
  bool has_face_uvs = false;  ///< texture coordinates listed per face
};

/// Reads a PLY file from its header to its last byte, because the importer trusts every count and
/// reads past the end. Refuses, naming the vertex or face: headers with wrong counts, truncated
/// files, malformed or non-finite numbers, faces with fewer than three corners, indices out of
/// range.
[[nodiscard]] Result<PlyFacts> check_ply(std::string_view bytes, const std::filesystem::path& path,
                                         const Context& context);

}  // namespace hydroprint::mesh
