#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "sim/base/pose.h"
#include "sim/mesh/surface.h"

namespace hydroprint::registration {

/// A point of a surface.
struct SurfacePoint {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< outward, unit, smooth except at creases
};

/// A surface with a search structure for nearest points and rays, for comparison with scans. Body
/// frame B, mm. Thread-safe; copies share their data.
class Shape {
 public:
  /// @param surface  has at least one triangle
  explicit Shape(const mesh::Surface& surface);

  /// Returns the nearest point of the surface.
  [[nodiscard]] SurfacePoint closest(const Eigen::Vector3d& p_B) const;
  /// Returns the first intersection of a ray with the surface, from either side; nullopt if there
  /// is none.
  [[nodiscard]] std::optional<SurfacePoint> hit(const Eigen::Vector3d& from_B,
                                                const Eigen::Vector3d& towards_B) const;
  /// Returns true if the surface faces the eye at a point, and no part of it lies in between.
  [[nodiscard]] bool is_seen(const SurfacePoint& p_B, const Eigen::Vector3d& eye_B) const;
  /// Returns about `count` points, distributed evenly over the area. Deterministic.
  [[nodiscard]] std::vector<SurfacePoint> samples(std::size_t count) const;

  /// Returns the root mean square distance of the surface from its centroid.
  [[nodiscard]] double radius_mm() const;
  [[nodiscard]] const Eigen::Vector3d& centroid() const;
  /// Returns the diagonal of the bounding box.
  [[nodiscard]] double diagonal_mm() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

/// Transforms the surface by `pose`.
[[nodiscard]] mesh::Surface moved(mesh::Surface surface, const Pose& pose);
/// Mirrors the surface (x to -x). Its normals still point outward.
[[nodiscard]] mesh::Surface mirrored(mesh::Surface surface);
/// Combines two surfaces into one.
[[nodiscard]] mesh::Surface joined(mesh::Surface a, const mesh::Surface& b);

}  // namespace hydroprint::registration
