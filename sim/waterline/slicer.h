#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/waterline/body.h"

namespace hydroprint::waterline {

/// The intersection of one triangle with the water surface. The solid lies to the left of a -> b.
struct Segment {
  Eigen::Vector2d a_mm, b_mm;
  Eigen::Vector2d pull_a, pull_b;  ///< film velocity per unit dip speed at the ends (eq. 1)
};

/// A closed curve of segments, each ending at the next one's start. The solid lies to its left.
using Contour = std::vector<Segment>;

/// Slices a body at any immersion. Triangles are binned by height once, so that the cost of a cut
/// is proportional to the size of its result.
class Slicer {
 public:
  explicit Slicer(const Body& body);

  /// Returns the curves in which the body's triangles intersect the water surface. Vertices exactly
  /// at the water level count as dry, so all curves of a closed body are closed. Curves of an open
  /// or non-manifold body are closed by straight lines between the nearest ends.
  [[nodiscard]] std::vector<Contour> cut(double immersion_mm) const;

 private:
  const Body* body_;
  double bins_per_mm_ = 1;
  std::vector<int> bin_start_;  ///< start of each bin in bin_triangles_, and the end of the last
  std::vector<int> bin_triangles_;
};

}  // namespace hydroprint::waterline
