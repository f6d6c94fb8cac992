#pragma once

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_mesh_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <cstddef>

#include "sim/velocity/sizing.h"

namespace hydroprint::velocity {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// The plane around the film as triangles. Its constrained edges are the film's edge and the
/// waterlines. Faces of the film are marked as in the domain.
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel,
    CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<Kernel>,
                                         CGAL::Delaunay_mesh_face_base_2<Kernel>>,
    CGAL::Exact_predicates_tag>;

/// Triangles whose edges are all shorter than this are not refined for their angles, and edges of
/// waterlines that are shorter are not divided for them. Otherwise, gaps between waterlines that
/// nearly touch would be filled with ever smaller triangles. Solid thinner than this does not
/// refine the film on either side.
inline constexpr double kTiny_mm = 0.1;

/// Refines the film to angles of at least 30 degrees (where the boundary permits) and to the sizing
/// field, whose sizes must exceed kTiny_mm.
/// @return false if that needs more than `most` vertices
[[nodiscard]] bool refine(Triangulation& triangulation, const Sizing& sizing, std::size_t most);

}  // namespace hydroprint::velocity
