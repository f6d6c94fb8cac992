#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "sim/plan/facets.h"
#include "sim/plan/fragments.h"

namespace hydroprint::plan {

/// A border of two fragments inside their triangle.
struct InnerBorder {
  int fragment = 0;
  int other = 0;
  std::array<Eigen::Vector3d, 2> ends;  ///< barycentric
  double length_mm = 0;
};

/// A part of an edge along which each triangle at the edge has one fragment.
struct EdgeBorder {
  std::size_t edge = 0;
  /// Fractions along the direction of the edge's first side.
  double from = 0;
  double to = 0;
  double length_mm = 0;
  std::size_t first_fragment = 0;  ///< into Borders::edge_fragments: one per side of the edge
};

/// All borders between fragments, also those of the same dip.
struct Borders {
  std::vector<InnerBorder> inner;
  std::vector<EdgeBorder> across;
  std::vector<int> edge_fragments;

  /// Returns the fragments along a border in the order of the sides of its edge.
  [[nodiscard]] std::span<const int> fragments(const EdgeBorder& border,
                                               const Facets& facets) const {
    return std::span(edge_fragments)
        .subspan(border.first_fragment, facets.edges().sides(border.edge).size());
  }
};

[[nodiscard]] Borders find_borders(const Facets& facets, const Fragments& fragments);

/// Returns the fraction along `side` for a fraction along the first side of its edge.
[[nodiscard]] double fraction_on(int side, double fraction, const Facets& facets);

}  // namespace hydroprint::plan
