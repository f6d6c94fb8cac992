#pragma once

#include <cstddef>

#include "sim/base/context.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"

namespace hydroprint::mesh {

/// Faces are subdivided to this edge length unless told otherwise (contract, `surface_map.ply`).
inline constexpr double kMaxEdgeMm = 2;
/// More triangles than this are not made by subdivision.
inline constexpr std::size_t kMaxSubdividedTriangles = 8'000'000;

/// Welds, orients outward, subdivides and finds normals. Works on whatever a Model holds: open,
/// non-manifold, of many shells, inside out; Surface::warnings says what was assumed.
/// Points that subdivision adds are shared over UV seams; old ones stay as the model has them.
/// Refuses an edge length that is not positive (kInvalidArgument), a model whose faces all vanish
/// (kInvalidArgument), and one that would take more than kMaxSubdividedTriangles
/// (kResourceExhausted). Linear in the number of triangles; the result does not depend on threads.
[[nodiscard]] Result<Surface> make_surface(const Model& model, double max_edge_mm,
                                           const Context& context);

}  // namespace hydroprint::mesh
