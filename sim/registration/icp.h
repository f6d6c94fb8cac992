#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/registration/shape.h"
#include "sim/scan/cloud.h"

namespace hydroprint::registration {

/// The result of an alignment.
struct Aligned {
  Pose pose = Pose::Identity();  ///< takes the scan's points to the target
  bool converged = false;
};

/// Improves a start until fit_pose() can refine it: PCL's point-to-plane ICP (Besl and McKay 1992,
/// Chen and Medioni 1992) against a surface given by samples. Points whose normals differ by more
/// than 60 degrees are not paired. Thread-safe.
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

/// Returns a regular subset of a scan's points for align(): `most` points or up to twice as many.
[[nodiscard]] std::vector<SurfacePoint> thinned(std::span<const scan::ScanPoint> points,
                                                std::size_t most);

/// Builds an Icp for a target. PCL depends on 30 libraries, which take a tenth of a second to load
/// and which most runs of the worker do not need. So it is in a module that the first call loads.
/// Fails as module_symbol() does.
[[nodiscard]] Result<std::unique_ptr<const Icp>> make_icp(std::span<const SurfacePoint> target);

}  // namespace hydroprint::registration

/// The only symbol that the module exports. The caller owns the result.
extern "C" hydroprint::registration::Icp* hydroprint_icp(
    std::span<const hydroprint::registration::SurfacePoint> target);
