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
  Pose pose = Pose::Identity();  ///< transforms the scan's points to the target
  bool converged = false;
};

/// Refines an initial pose until fit_pose() can take over. Uses PCL's point-to-plane ICP (Besl and
/// McKay 1992, Chen and Medioni 1992) against samples of a surface. Points whose normals differ by
/// more than 60 degrees are not paired. Thread-safe.
class Icp {
 public:
  Icp() = default;
  virtual ~Icp() = default;
  Icp(const Icp&) = delete;
  Icp& operator=(const Icp&) = delete;

  /// @param scan         points with normals, at least 6
  /// @param distance_mm  maximum distance between paired points
  [[nodiscard]] virtual Aligned align(std::span<const SurfacePoint> scan, const Pose& start,
                                      double distance_mm, int iterations) const = 0;
};

/// Returns every n-th point of a scan, for align(): between `most` and 2 * `most` points, or all of
/// them if there are fewer.
[[nodiscard]] std::vector<SurfacePoint> thinned(std::span<const scan::ScanPoint> points,
                                                std::size_t most);

/// Creates an Icp for a target. The implementation is in a module that the first call loads,
/// because PCL depends on 30 libraries that take a tenth of a second to load, and most runs of the
/// worker do not need PCL. Returns the errors of module_symbol().
[[nodiscard]] Result<std::unique_ptr<const Icp>> make_icp(std::span<const SurfacePoint> target);

}  // namespace hydroprint::registration

/// The only symbol that the module exports. The caller takes ownership of the result.
extern "C" hydroprint::registration::Icp* hydroprint_icp(
    std::span<const hydroprint::registration::SurfacePoint> target);
