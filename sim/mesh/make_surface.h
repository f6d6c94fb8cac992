#pragma once

#include <cstddef>

#include "sim/base/context.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"

namespace hydroprint::mesh {

/// Default maximum edge length; longer edges are subdivided.
inline constexpr double kMaxEdgeMm = 2;
/// Maximum number of triangles that subdivision may produce.
inline constexpr std::size_t kMaxSubdividedTriangles = 8'000'000;

/// Welds and orients a model, subdivides it and computes normals. Accepts any Model: open,
/// non-manifold, with many shells, inside out. Surface::warnings lists the assumptions made. Points
/// added by subdivision are shared across UV seams; the model's own points stay unchanged. Errors:
/// kInvalidArgument for an edge length that is not positive and for a model whose faces are all
/// degenerate, kResourceExhausted for more than kMaxSubdividedTriangles. Takes about n
/// log n time for n triangles; the result does not depend on the number of threads.
[[nodiscard]] Result<Surface> make_surface(const Model& model, double max_edge_mm,
                                           const Context& context);

}  // namespace hydroprint::mesh
