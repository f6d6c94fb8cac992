#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/image/io/image_file.h"
#include "sim/mesh/model.h"

namespace hydroprint::image {

/// The part of a texture that one connected piece of the unwrapped surface uses.
struct Chart {
  std::uint16_t id = 0;  ///< averages skip texels of other charts; 0: they use all texels
  /// Per axis: the whole chart lies in the unit tile that starts at `tile`, so filters stop at the
  /// tile's edge instead of wrapping around to the opposite one.
  std::array<bool, 2> in_one_tile = {false, false};
  std::array<double, 2> tile = {0, 0};
};

/// A triangle of the unwrapped surface: texture coordinates (v up), and the corners' positions,
/// which distinguish seams from other edges.
struct UvTriangle {
  std::array<Eigen::Vector2d, 3> uv;
  std::array<Eigen::Vector3d, 3> position;
};

/// Finds the charts (triangles joined along edges equal in space and in the texture) and marks
/// their texels. Extends each by up to 16 texels of background with the nearest texel's colour.
/// Overlapping charts (mirrored halves) count as one. If the coordinates cover the texture more
/// than 64 times over, every id stays 0.
/// @return the chart of each triangle
[[nodiscard]] std::vector<Chart> make_charts(const std::vector<UvTriangle>& triangles,
                                             mesh::Wrap wrap_u, mesh::Wrap wrap_v, Texels& texels);

}  // namespace hydroprint::image
