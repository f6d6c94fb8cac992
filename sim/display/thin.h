#pragma once

#include <cstddef>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/display/corners.h"

namespace hydroprint::display {

/// A mesh with fewer triangles.
struct Thinned {
  CornerMesh mesh;
  /// Pieces smaller than a cell vanished, so that the mesh consists of the largest triangles
  /// instead.
  bool is_in_part = false;
};

/// Reduces a mesh to at most `most` triangles by vertex clustering on a cubic grid. Corners in one
/// cell become one if edges within the cell connect them, so the sides of a thin wall stay apart.
/// The new corner has their mean position; its texture coordinates and colour are the means of
/// those connected on the same side of seams and in the same material, so no triangle spans a seam.
/// If that leaves less than half of the surface, because it consists of pieces smaller than a cell,
/// takes the largest triangles as they are. A mesh that is small enough is returned unchanged.
/// Places do not depend on texture coordinates, colours and materials; they are numbered in order
/// of first use.
[[nodiscard]] Result<Thinned> thin(CornerMesh mesh, std::size_t most, const Context& context);

}  // namespace hydroprint::display
