#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sim/validate/measure.h"

namespace hydroprint::validate {

inline constexpr double kDegree = 3.14159265358979323846 / 180;
inline constexpr double kSphere80_mm = 80, kGlobe_mm = 60;  ///< radii of the samples

/// Returns the angle, in degrees, between a sphere's surface and the water when the water reaches
/// the point p.
[[nodiscard]] inline double theta_deg(const Eigen::Vector3d& p) {
  return std::acos(std::clamp(-p.z() / p.norm(), -1.0, 1.0)) / kDegree;
}

/// A region with a name for display.
struct NamedRegion {
  std::string name;
  Region region;
};

/// Returns the part of a sphere between two angles to the water.
[[nodiscard]] inline NamedRegion band(double from_deg, double to_deg, const std::string& name) {
  return {name, [=](const Eigen::Vector3d& p) {
            const double theta = theta_deg(p);
            return theta >= from_deg - 1e-6 && theta <= to_deg + 1e-6;
          }};
}

}  // namespace hydroprint::validate
