#pragma once

#include "sim/scan/fixed_pattern.h"
#include "sim/scan/lens.h"

namespace hydroprint::scan {

/// The calibration of a depth camera.
struct Camera {
  Lens lens;
  Lens::Matrix covariance = Lens::Matrix::Zero();  ///< covariance of Lens::parameters()
  FixedPattern pattern = {};                       ///< may be unknown
};

}  // namespace hydroprint::scan
