#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "sim/flow/trace.h"

namespace hydroprint::sheet {

/// Returns the mean thickness, in mm, of the film at rest over a triangle. The corners are given in
/// F, for the swollen film floating at rest.
using RestThickness = std::function<double(const std::array<Eigen::Vector2d, 3>& rest_mm)>;

/// The floating film at one waterline, for each triangle of the film mesh.
struct FloatingFilm {
  std::vector<double> thickness_mm;
  std::vector<char> is_torn;
};

/// Computes the thickness of the floating film on each triangle of the film mesh of waterline `k`,
/// from the conservation of volume (section 4.3): h = h0 A0 / A. A0 is the rest area of the
/// material in the triangle, found by tracing the triangle's nodes back through the dip. Thickness
/// thus moves with the material and is never interpolated from mesh to mesh. Area ratios are
/// limited to five, because film stretched further has torn, and film compressed further has
/// wrinkled.
/// @param tear_stretch  film is torn where its larger principal stretch exceeds this, or where the
///                      material that was traced back is folded
/// @param known         rest positions of the film at an earlier waterline; nullptr: the film is
///                      traced back to rest
[[nodiscard]] FloatingFilm floating_film(const flow::DipField& dip, std::size_t k,
                                         const RestThickness& rest_thickness, double tear_stretch,
                                         const flow::RestMap* known = nullptr);

}  // namespace hydroprint::sheet
