#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/scan/lens.h"

namespace hydroprint::scan {

/// A lens with the rays of all its pixels, which are slow to compute.
struct Optics {
  Lens lens;
  std::vector<Eigen::Vector3d> rays;

  explicit Optics(const Lens& of) : lens(of), rays(of.rays()) {}
};

}  // namespace hydroprint::scan
