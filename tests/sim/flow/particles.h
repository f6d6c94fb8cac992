#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sim/flow/trace.h"
#include "sim/waterline/body.h"

namespace hydroprint::flow::reference {

/// The paper's method (section 4.5) in its simplest form. Film points are advected with the
/// velocity field, interpolated linearly in depth, by small fourth-order Runge-Kutta steps. A
/// point lands where its path, in the frame of the body, crosses a triangle.
class Particles {
 public:
  Particles(const waterline::Body& body, const DipField& dip, double step_mm);

  struct Contact {
    int triangle = 0;
    Eigen::Vector3d barycentric;
  };

  /// The landing point of a film point; nullopt if the film point still floats at the end of the
  /// dip.
  [[nodiscard]] std::optional<Contact> follow(Eigen::Vector2d film_mm) const;

 private:
  [[nodiscard]] Eigen::Vector2d velocity(const Eigen::Vector2d& point_mm, double depth_mm) const;
  [[nodiscard]] std::optional<Contact> contact(const Eigen::Vector3d& from,
                                               const Eigen::Vector3d& to) const;

  const waterline::Body& body_;
  const DipField& dip_;
  double step_mm_;
  std::vector<std::vector<int>> layers_;  ///< triangles that touch each 1 mm layer of height
};

}  // namespace hydroprint::flow::reference
