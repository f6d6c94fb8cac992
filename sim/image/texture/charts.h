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
  std::uint16_t id = 0;  ///< texels of other charts are left out of averages; 0: all are taken
  /// Per axis: the whole chart lies in the unit tile that starts here, so that filters stop at the
  /// tile's edge instead of wrapping round to the opposite one.
  std::array<bool, 2> in_one_tile = {false, false};
  std::array<double, 2> tile = {0, 0};
};

/// A triangle of the unwrapped surface: texture coordinates (v up), and the corners' positions,
/// which tell seams from mere edges.
struct UvTriangle {
  std::array<Eigen::Vector2d, 3> uv;
  std::array<Eigen::Vector3d, 3> position;
};

/// Finds the charts (triangles joined along edges equal in space and in the texture), marks their
/// texels and extends each by up to 16 texels of background with the nearest texel's colour. Charts
/// that lie on each other (mirrored halves) count as one. Gives up, every id 0, on coordinates that
/// cover the texture more than 64 times over.
/// @return per triangle its chart
[[nodiscard]] std::vector<Chart> make_charts(const std::vector<UvTriangle>& triangles,
                                             mesh::Wrap wrap_u, mesh::Wrap wrap_v, Texels& texels);

}  // namespace hydroprint::image
