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
  std::uint16_t id = 0;  ///< averages skip texels of other charts; 0: averages use all texels
  /// For each axis, true if the whole chart lies in the unit tile that starts at `tile`. Filters
  /// then stop at the tile's edge instead of wrapping to the opposite one.
  std::array<bool, 2> in_one_tile = {false, false};
  std::array<double, 2> tile = {0, 0};
};

/// A triangle of the unwrapped surface: texture coordinates (v up), and the positions of its
/// corners, which distinguish seams from other edges.
struct UvTriangle {
  std::array<Eigen::Vector2d, 3> uv;
  std::array<Eigen::Vector3d, 3> position;
};

/// Finds the charts and labels their texels. Two triangles belong to the same chart if they share
/// an edge both in space and in the texture. Each chart is dilated by up to 16 texels into the
/// background, using the nearest texel's colour. Charts that overlap, such as mirrored halves, are
/// merged. If the triangles cover more than 64 times the area of the texture, no texel is labelled
/// (all ids are 0).
/// @return the chart of each triangle
[[nodiscard]] std::vector<Chart> make_charts(const std::vector<UvTriangle>& triangles,
                                             mesh::Wrap wrap_u, mesh::Wrap wrap_v, Texels& texels);

}  // namespace hydroprint::image
