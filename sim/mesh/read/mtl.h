#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sim/base/result.h"
#include "sim/mesh/model.h"

namespace hydroprint::mesh {

/// A material of an MTL file.
struct MtlMaterial {
  std::string name;
  std::optional<Eigen::Vector3f> colour;  ///< Kd, sRGB-coded [0, 1]
  std::string texture;                    ///< file name of map_Kd, else of map_Ka; empty: none
  Wrap wrap = Wrap::kRepeat;
  Eigen::Vector2f scale = {1, 1};           ///< of texture coordinates (-s)
  Eigen::Vector2f offset = {0, 0};          ///< added to them afterwards (-o)
  std::vector<std::string> not_understood;  ///< what might define its colour, but is not supported
};

/// The materials of one file.
struct MtlFile {
  std::vector<MtlMaterial> materials;
  Warnings warnings;
};

/// Parses an MTL file ("Object Files, MTL material format", Alias Wavefront 1995). Keywords may
/// have any case, lines any end, map_Kd its options in front of the name or behind it, and decimal
/// commas are read. Of a material without map_Kd, map_Ka is used, with a warning.
/// Errors are kInvalidArgument and name the line: malformed numbers, unknown options of map_Kd,
/// binary data.
[[nodiscard]] Result<MtlFile> parse_mtl(std::string_view text, const std::filesystem::path& path);

}  // namespace hydroprint::mesh
