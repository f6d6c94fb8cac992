#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/flow/surface_map.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// Returns the tile's corners on the object, frame O, mm.
[[nodiscard]] std::array<Eigen::Vector3d, 3> tile_points(const mesh::Surface& surface,
                                                         const flow::MappedTriangle& tile);

/// Selects a singular value of the film-to-surface Jacobian.
enum class Stretch { kLargest, kLeast };

/// Returns the selected singular value at a tile's corners (section 6). It is interpolated from the
/// three surface points around the tile if all of them have a value; otherwise it is that of the
/// tile itself. NaN for a tile whose film has no area.
[[nodiscard]] std::array<double, 3> tile_stretch(const mesh::Surface& surface,
                                                 const flow::SurfaceMap& map,
                                                 const flow::MappedTriangle& tile,
                                                 Stretch which = Stretch::kLargest);

}  // namespace hydroprint::image
