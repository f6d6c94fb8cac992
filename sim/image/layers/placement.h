#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/base/result.h"
#include "sim/image/layers/layer.h"
#include "sim/mesh/model.h"

namespace hydroprint::image {

/// An affine map from points of frame O to places on a picture (v up).
struct PlaneMap {
  Eigen::Matrix<double, 2, 3> per_mm = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Vector2d at_origin = Eigen::Vector2d::Zero();

  [[nodiscard]] Eigen::Vector2d uv(const Eigen::Vector3d& p) const {
    return per_mm * p + at_origin;
  }
};

/// Where the picture of a layer is on the object: all that the formulas of PaintLayer need, with
/// the defaults filled in. Frame O, mm.
struct Placement {
  Projection projection = Projection::kPlanar;
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();
  /// Axes r, u, d: the picture's right and up, and the direction of view.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns
  double width_mm = 1, height_mm = 1;                  ///< of the picture on the object
  double radius_mm = 1;                                ///< of kCylindrical: R
  double depth_mm = 0;                                 ///< of kDecal; 0: unlimited
  double blend_mm = 1;                                 ///< of kBox
  double turn_rad = 0;
  bool mirror = false, repeat = false;

  /// Returns the place on the picture of a point at (s, t) mm from its middle.
  [[nodiscard]] Eigen::Vector2d uv(const Eigen::Vector2d& at_mm) const;

  /// Returns the map of a plane: for kBox that along axis 0, 1 or 2 (r, u, d), otherwise that along
  /// d. Not for kCylindrical.
  [[nodiscard]] PlaneMap plane(int axis = 2) const;

  /// Returns the angle of a point around the axis of kCylindrical, minus the turn, in (-pi, pi].
  [[nodiscard]] double angle_rad(const Eigen::Vector3d& p) const;
  /// Returns the place on the picture of kCylindrical at an angle from angle_rad() or a whole
  /// number of turns beside it.
  [[nodiscard]] Eigen::Vector2d around(double angle_rad, const Eigen::Vector3d& p) const;
};

/// Places a layer of one of the projections with a position on a model.
/// @param R_FO    rotation from frame O to frame F at the start of the dip
/// @param aspect  width of the picture divided by its height
/// @return kInvalidArgument with the layer's name for directions without length, or an up direction
///     within one degree of the direction of view
[[nodiscard]] Result<Placement> place(const Layer& layer, Projection projection,
                                      const mesh::Model& model, const Eigen::Matrix3d& R_FO,
                                      double aspect);

}  // namespace hydroprint::image
