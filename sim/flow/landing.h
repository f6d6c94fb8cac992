#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/waterline/body.h"
#include "sim/waterline/motion.h"

namespace hydroprint::flow {

/// A point of the surface at the moment the water reaches it.
struct Landing {
  Eigen::Vector2d point_mm = Eigen::Vector2d::Zero();  ///< position on the water surface, in F
  double immersion_mm = 0;
  /// Film velocity per unit dip speed by eq. (1); at a crease, the mean of the two sides.
  Eigen::Vector2d pull = Eigen::Vector2d::Zero();
  bool is_smooth = false;        ///< no crease nearby, so `pull` is the film's velocity here
  bool film_can_follow = false;  ///< false: no film arrives, because the surface recedes too fast
};

/// Combines the landings that two triangles have at a shared point: the mean of their pulls; smooth
/// if both landings are smooth.
[[nodiscard]] Landing shared(const Landing& a, const Landing& b);

/// The landings of a body's surface.
class Landings {
 public:
  Landings(const waterline::Body& body, const waterline::Motion& motion);

  /// Returns the landing of each welded point; the immersion of a point without triangles is
  /// infinite.
  [[nodiscard]] const std::vector<Landing>& of_points() const { return points_; }

  /// Returns the landing at a point inside a triangle; `barycentric` refers to corners 0, 1, 2.
  [[nodiscard]] Landing on(int triangle, const Eigen::Vector3d& barycentric) const;

 private:
  [[nodiscard]] Landing at(const Eigen::Vector3d& point_mm, const Eigen::Vector2d& pull) const;

  const waterline::Body& body_;
  const waterline::Motion& motion_;
  std::vector<Landing> points_;
};

}  // namespace hydroprint::flow
