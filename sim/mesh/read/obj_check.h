#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/context.h"

namespace hydroprint::mesh {

/// Facts about an OBJ file, collected while checking it.
struct ObjFacts {
  std::size_t vertices = 0;
  std::size_t texture_coordinates = 0;
  std::size_t triangles = 0;           ///< after polygons are split
  std::vector<std::string> libraries;  ///< arguments of `mtllib`, one per line
  bool has_bare_usemtl = false;        ///< a line `usemtl` without a name
  /// Colours of the vertices as written, in any range, NaN where one is not a number: of
  /// `v x y z r g b [a]`, else of ZBrush's `#MRGB` comments. White for vertices without one; empty
  /// if none has one.
  std::vector<Eigen::Vector3f> vertex_colours;
  std::size_t coloured_vertices = 0;
  std::vector<std::string> not_understood;  ///< what might define colours, but could not be read
};

/// Checks every line of an OBJ file strictly, because the importer reads malformed numbers as 0 and
/// accepts indices out of range. Seven numbers of a vertex are x y z r g b a, as scanners write
/// them (x y z w r g b is unknown in practice). Rejects malformed or non-finite numbers, faces with
/// fewer than three corners, indices out of range, and binary data. Errors name the line.
[[nodiscard]] Result<ObjFacts> check_obj(std::string_view text, const std::filesystem::path& path,
                                         const Context& context);

}  // namespace hydroprint::mesh
