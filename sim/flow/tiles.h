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

struct Tiles {
  std::vector<MappedTriangle> tiles;
  bool is_limited = false;  ///< see FlowMap::is_limited
};

/// Tiles the part of the surface that the film reaches. An edge is divided if its midpoint does not
/// land halfway, or if only one of its ends is reached. Division ends when tiles are linear or as
/// small as a pixel, or at a limit on the number of tiles. Tiles that still cross a jump of the map
/// are then dropped.
/// @param film_mm  per welded point of the body: the floating film point that lands there; NaN if
///                 none
[[nodiscard]] Result<Tiles> make_tiles(const waterline::Body& body, const DipField& dip,
                                       const Landings& landings,
                                       const std::vector<Eigen::Vector2d>& film_mm,
                                       const MapOptions& options, const Context& context);

}  // namespace hydroprint::flow
