#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "sim/flow/trace.h"

namespace hydroprint::sheet {

/// Mean thickness of the film at rest over a triangle of it, mm; the corners in F as it floats at
/// rest (swollen).
using RestThickness = std::function<double(const std::array<Eigen::Vector2d, 3>& rest_mm)>;

/// Thickness of the floating film on each triangle of the film mesh of waterline `k`, from the
/// conservation of volume (section 4.3): h = h0 A0 / A, where A0 is the area of the material at
/// rest that has become the triangle, found by following its nodes back through the dip. The
/// material carries its thickness, which is never interpolated from mesh to mesh.
///
/// Area ratios beyond five, where film would long have wrinkled or torn, count as five.
/// @param known  where the film was at rest at a waterline before; none: followed back all the way
[[nodiscard]] std::vector<double> thickness_mm(const flow::DipField& dip, std::size_t k,
                                               const RestThickness& rest_thickness,
                                               const flow::RestMap* known = nullptr);

}  // namespace hydroprint::sheet
