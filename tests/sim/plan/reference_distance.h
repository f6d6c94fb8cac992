#pragma once

#include "sim/mesh/surface.h"
#include "sim/plan/regions.h"
#include "tests/sim/plan/fields.h"

namespace hydroprint::testing {

/// Returns the geodesic distance from a point to the region of a dip by
/// CGAL::Surface_mesh_shortest_path, with the region's polygons sampled every 0.04 mm; infinity if
/// it is more than `limit_mm`. The surface must be manifold within that distance.
[[nodiscard]] double reference_distance(const mesh::Surface& surface, const plan::Regions& regions,
                                        int dip, const SurfacePoint& point, double limit_mm);

}  // namespace hydroprint::testing
