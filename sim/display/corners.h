#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sim/image/texture/paint.h"
#include "sim/mesh/model.h"

namespace hydroprint::display {

/// A corner of triangles: a place with everything that its colour depends on.
struct Corner {
  Eigen::Vector3f position =
      Eigen::Vector3f::Zero();                       ///< mm, relative to the origin of the display
  Eigen::Vector2f uv = Eigen::Vector2f::Zero();      ///< v up
  Eigen::Vector3f colour = Eigen::Vector3f::Ones();  ///< linear
  int ink = 0;                                       ///< image::Paint::ink_index()
};

/// The triangles of a model, with corners that are shared where all their members agree. So two
/// sides of a seam of the texture, or two materials, have corners of their own.
struct CornerMesh {
  std::vector<Corner> corners;
  std::vector<Eigen::Vector3i> triangles;  ///< indices of corners
  std::vector<int> ink;                    ///< per triangle
  /// Per corner, a number that corners have in common if and only if they are at the same place.
  /// Places are numbered in order of first use.
  std::vector<int> place;
  int places = 0;
};

/// Finds the corners of a model's triangles.
/// @param origin_mm  frame O; positions become relative to it
[[nodiscard]] CornerMesh find_corners(const mesh::Model& model, const image::Paint& paint,
                                      const Eigen::Vector3d& origin_mm);

}  // namespace hydroprint::display
