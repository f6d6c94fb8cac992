#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/context.h"

namespace hydroprint::mesh {

/// What the check of an OBJ file finds on its way.
struct ObjFacts {
  std::size_t vertices = 0;
  std::size_t texture_coordinates = 0;
  std::size_t triangles = 0;                    ///< once polygons are cut up
  std::vector<std::string> libraries;           ///< what follows `mtllib`, a line each
  std::vector<Eigen::Vector3f> vertex_colours;  ///< of `v x y z r g b`; some or all vertices
};

/// Reads every line of an OBJ file strictly, since the importer takes what is no number for 0 and
/// lets indices out of range pass. Refuses, with the line: numbers that are none or not finite,
/// faces of fewer than three corners, indices out of range, binary data.
[[nodiscard]] Result<ObjFacts> check_obj(std::string_view text, const std::filesystem::path& path,
                                         const Context& context);

}  // namespace hydroprint::mesh
