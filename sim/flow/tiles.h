#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "sim/base/context.h"
#include "sim/flow/flow_map.h"
#include "sim/flow/landing.h"
#include "sim/flow/trace.h"

namespace hydroprint::flow {

/// Tiles the reached surface. Edges whose middle lands elsewhere than halfway are divided, as are
/// edges with only one end reached, until tiles are linear or as small as a pixel; a tile that a
/// jump of the map still crosses then is left out.
/// @param film_mm  per welded point of the body: the floating film that lands there, NaN if none
[[nodiscard]] Result<std::vector<MappedTriangle>> make_tiles(
    const waterline::Body& body, const DipField& dip, const Landings& landings,
    const std::vector<Eigen::Vector2d>& film_mm, const MapOptions& options, const Context& context);

}  // namespace hydroprint::flow
