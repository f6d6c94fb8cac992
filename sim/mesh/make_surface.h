#pragma once

#include <cstddef>

#include "sim/base/context.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"

namespace hydroprint::mesh {

/// Default edge length to which faces are subdivided (contract, `surface_map.ply`).
inline constexpr double kMaxEdgeMm = 2;
/// Subdivision produces at most this many triangles.
inline constexpr std::size_t kMaxSubdividedTriangles = 8'000'000;

/// Welds, orients outward, subdivides and computes normals. Handles any Model: open, non-manifold,
/// with many shells, inside out. Surface::warnings lists the assumptions made. Points added by
/// subdivision are shared across UV seams; the model's own points stay unchanged.
/// Errors: kInvalidArgument for an edge length that is not positive and for a model whose faces all
/// vanish, kResourceExhausted for more than kMaxSubdividedTriangles. Takes time linear in the
/// number of triangles; the result does not depend on the number of threads.
[[nodiscard]] Result<Surface> make_surface(const Model& model, double max_edge_mm,
                                           const Context& context);

}  // namespace hydroprint::mesh
