#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "sim/base/context.h"

namespace hydroprint::mesh {

/// What the check of a PLY file finds on its way.
struct PlyFacts {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::string texture;        ///< of a `comment TextureFile NAME` line
  bool has_face_uvs = false;  ///< texture coordinates listed per face
};

/// Walks a PLY file from its header to its last byte, since the importer believes every count it is
/// told and reads past the end. Refuses, with the vertex or face: headers that lie, truncated
/// files, numbers that are none or not finite, faces of fewer than three corners, indices out of
/// range.
[[nodiscard]] Result<PlyFacts> check_ply(std::string_view bytes, const std::filesystem::path& path,
                                         const Context& context);

}  // namespace hydroprint::mesh
