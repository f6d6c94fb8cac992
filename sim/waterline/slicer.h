#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/waterline/body.h"

namespace hydroprint::waterline {

/// One triangle's cut with the water surface: the solid lies to the left of a -> b.
struct Segment {
  Eigen::Vector2d a_mm, b_mm;
  Eigen::Vector2d pull_a, pull_b;  ///< film velocity per unit dip speed at the ends (eq. 1)
};

/// A closed curve made of segments, end to start; the solid it bounds lies to its left.
using Contour = std::vector<Segment>;

/// Cuts a body at any immersion. Triangles are binned by height once, so that a cut costs what it
/// returns.
class Slicer {
 public:
  explicit Slicer(const Body& body);

  /// The curves along which the body's triangles meet the water. Vertices exactly at the water's
  /// level count as dry, so every curve of a closed body is closed. What an open or non-manifold
  /// body leaves open is closed by straight lines between the nearest ends.
  [[nodiscard]] std::vector<Contour> cut(double immersion_mm) const;

 private:
  const Body* body_;
  double bins_per_mm_ = 1;
  std::vector<int> bin_start_;  ///< into bin_triangles_, one more than bins
  std::vector<int> bin_triangles_;
};

}  // namespace hydroprint::waterline
