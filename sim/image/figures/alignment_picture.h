#pragma once

#include <span>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/figures/object_views.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// Draws a sheet of views of the object without film (`views` has no tiles), with the points of a
/// scan on top. Points are coloured by their distance from the surface: blue inside, red outside.
/// @param points_O  frame O
/// @param off_mm    distance of each point from the surface, positive outward
[[nodiscard]] Result<RgbImage> alignment_picture(const ObjectViews& views,
                                                 std::span<const Eigen::Vector3d> points_O,
                                                 std::span<const double> off_mm,
                                                 const Context& context);

}  // namespace hydroprint::image
