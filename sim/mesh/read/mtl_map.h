#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace hydroprint::mesh {

/// The arguments of a texture statement in an MTL file: `map_Kd [options] FILE`.
struct MtlMap {
  std::string file;  ///< may contain blanks; without quotation marks
  bool clamp = false;
  Eigen::Vector3f scale = {1, 1, 1};   ///< -s u [v [w]]
  Eigen::Vector3f offset = {0, 0, 0};  ///< -o u [v [w]]
  std::string ignored;                 ///< an option that changes the picture, but is not supported
};

/// Parses the text after the keyword. Options stand in front of the file, as the format says, or
/// behind it, as some programs write them. -o, -s and -t have one to three numbers.
/// @return otherwise one sentence that names the option at fault and the remedy
[[nodiscard]] tl::expected<MtlMap, std::string> parse_mtl_map(std::string_view text);

}  // namespace hydroprint::mesh
