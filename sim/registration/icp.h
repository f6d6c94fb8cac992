#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// Where an alignment ended.
struct Aligned {
  Pose pose = Pose::Identity();  ///< takes the scan's points to the target
  bool converged = false;
};

/// Brings a start near to where fit_pose() takes over: PCL's point-to-plane ICP (Besl and McKay
/// 1992, Chen and Medioni 1992) against a surface given by samples. Points whose normals differ
/// by more than 60 degrees are not paired. May be used by several threads at once.
class Icp {
 public:
  Icp() = default;
  virtual ~Icp() = default;
  Icp(const Icp&) = delete;
  Icp& operator=(const Icp&) = delete;

  /// @param scan         points with normals, at least 6
  /// @param distance_mm  points farther apart are not paired
  [[nodiscard]] virtual Aligned align(std::span<const SurfacePoint> scan, const Pose& start,
                                      double distance_mm, int iterations) const = 0;
};

/// Every so manieth of a scan's points, `most` or up to twice as many: enough for align().
[[nodiscard]] std::vector<SurfacePoint> thinned(std::span<const scan::ScanPoint> points,
                                                std::size_t most);

/// PCL brings 30 libraries along, a tenth of a second to load, and most of what the worker does
/// needs none of them. So this is a module, loaded when first asked for; refuses what
/// module_symbol() refuses.
[[nodiscard]] Result<std::unique_ptr<const Icp>> make_icp(std::span<const SurfacePoint> target);

}  // namespace hydroprint::registration

/// The one thing that the module exports. The caller's to delete.
extern "C" hydroprint::registration::Icp* hydroprint_icp(
    std::span<const hydroprint::registration::SurfacePoint> target);
