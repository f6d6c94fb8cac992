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

/// Tiles the reached surface. An edge is divided if its middle does not land halfway, or if only
/// one of its ends is reached. Division ends when tiles are linear or as small as a pixel. A tile
/// that still crosses a jump of the map is then left out.
/// @param film_mm  per welded point of the body: the floating film that lands there, NaN if none
[[nodiscard]] Result<std::vector<MappedTriangle>> make_tiles(
    const waterline::Body& body, const DipField& dip, const Landings& landings,
    const std::vector<Eigen::Vector2d>& film_mm, const MapOptions& options, const Context& context);

}  // namespace hydroprint::flow
