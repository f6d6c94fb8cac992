#pragma once

#include <cstddef>
#include <filesystem>

#include "sim/base/context.h"
#include "sim/mesh/model.h"

namespace hydroprint::mesh {

/// Maximum number of faces; models with more are rejected.
inline constexpr std::size_t kMaxFaces = 20'000'000;

/// Reads OBJ (with MTL), STL, PLY, glTF or GLB; the file extension selects the format. Polygons are
/// split into triangles. Vertices keep the file's order (STL: three per facet; glTF: in the order
/// of the scene's nodes, with node transforms applied). Textures are named in the materials but not
/// opened; a name that differs from the only such file just in case or Unicode form means it
/// (warning `SIMILAR_NAME`). Faces without area are dropped with the warning `ZERO_AREA_FACES`. A
/// missing material file or material is a warning. Errors are one line with file, place and remedy.
/// kNotFound: missing file. kOutOfRange: scale out of range. kInvalidArgument: unknown formats,
/// truncated files, headers that announce more than the file contains, coordinates that are not
/// finite, objects larger than 1 km or more than 10,000 km from the origin, indices out of range,
/// files without a face that has an area, more than kMaxFaces faces.
/// @param scale  millimetres per model unit, more than 1e-6 and less than 1e6
[[nodiscard]] Result<Model> read_model(const std::filesystem::path& path, double scale,
                                       const Context& context);

}  // namespace hydroprint::mesh
