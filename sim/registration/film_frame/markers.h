#pragma once

#include <string>
#include <vector>

#include "sim/mesh/surface.h"
#include "sim/registration/plane.h"
#include "sim/registration/pose_fit.h"

namespace hydroprint::registration {

/// A marker on a sliding bar. Frame M: origin in the middle of its square base, x and y along the
/// sides, z to the tip.
struct Marker {
  std::string name;
  Pose X_FM = Pose::Identity();
};

/// The rig's pyramids (paper, section 5.2), all of one size. z = 0 is the nominal water level.
struct MarkerLayout {
  double width_mm = 60;
  double height_mm = 40;
  std::vector<Marker> markers;
};

/// Returns the four sides of a pyramid; frame M.
[[nodiscard]] mesh::Surface pyramid(double width_mm, double height_mm);

/// A pyramid in a scan.
struct FoundMarker {
  PoseFit fit;  ///< pose of M in the camera frame, up to multiples of 90 degrees about z
  std::vector<scan::ScanPoint> points;

  [[nodiscard]] Eigen::Vector3d place_C() const { return fit.X_CB.translation(); }
};

/// Finds the upright pyramids with the layout's dimensions that stand on a horizontal surface.
/// Clusters of similar size and height are aligned with ICP and fit_pose(); clusters with another
/// shape are skipped.
/// @param level  a plane that defines up (find_plane)
[[nodiscard]] Result<std::vector<FoundMarker>> find_markers(const scan::Cloud& cloud,
                                                            const Plane& level,
                                                            const MarkerLayout& layout,
                                                            const Context& context);

}  // namespace hydroprint::registration
