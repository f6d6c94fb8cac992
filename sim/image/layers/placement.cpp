#include "sim/image/layers/placement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hydroprint::image {
namespace {

constexpr double kFullTurn_rad = 2 * std::numbers::pi;
/// Cosine of one degree: where the default up direction changes, and the least angle between up and
/// direction.
constexpr double kNearlyParallel = 0.99984770;
constexpr double kBlendPerSide = 0.1;

/// A bounding box with the directions of the columns of `axes`.
struct Box {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  [[nodiscard]] Eigen::Vector3d size() const { return high - low; }
};

Box box_of(const mesh::Model& model, const Eigen::Matrix3d& axes) {
  Box box;
  for (const Eigen::Vector3i& triangle : model.triangles) {
    for (const int v : triangle) {
      const Eigen::Vector3d p = axes.transpose() * model.vertices[static_cast<std::size_t>(v)];
      box.low = box.low.cwiseMin(p);
      box.high = box.high.cwiseMax(p);
    }
  }
  return box;
}

bool stands_upright(Projection projection) {
  return projection == Projection::kCylindrical || projection == Projection::kBox;
}

Eigen::Vector3d default_up(const Eigen::Vector3d& direction) {
  return std::abs(direction.z()) >= kNearlyParallel ? Eigen::Vector3d::UnitY()
                                                    : Eigen::Vector3d::UnitZ();
}

/// Returns the axes r, u, d as columns.
Result<Eigen::Matrix3d> axes_of(const Layer& layer, Projection projection,
                                const Eigen::Matrix3d& R_FO) {
  const bool in_F = projection == Projection::kDip;
  const Eigen::Vector3d usual =
      stands_upright(projection) ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d given = in_F ? usual : layer.direction.value_or(usual);
  if (!(given.norm() > 0))
    return fail(Code::kInvalidArgument, "layer " + layer.name + ": its direction has no length");
  Eigen::Vector3d d = given.normalized();
  const Eigen::Vector3d up = layer.up.value_or(default_up(d));
  if (!(up.norm() > 0))
    return fail(Code::kInvalidArgument, "layer " + layer.name + ": its up has no length");
  Eigen::Vector3d u = up.normalized();
  if (!(std::abs(d.dot(u)) < kNearlyParallel)) {
    return fail(Code::kInvalidArgument,
                "layer " + layer.name +
                    ": up is parallel to the direction of view. Choose another up direction");
  }
  if (projection == Projection::kCylindrical) {
    d = (d - d.dot(u) * u).normalized();
  } else {
    u = (u - u.dot(d) * d).normalized();
  }
  Eigen::Matrix3d axes;
  axes << d.cross(u), u, d;
  if (in_F) axes = R_FO.transpose() * axes;
  return axes;
}

/// Returns the larger side of the box in the picture's plane.
double side_of(Projection projection, const Eigen::Vector3d& size) {
  if (projection == Projection::kBox) return size.maxCoeff();
  if (projection == Projection::kCylindrical) return std::max(size.x(), size.z());
  return std::max(size.x(), size.y());
}

double default_width(Projection projection, double side_mm, double aspect) {
  if (projection == Projection::kCylindrical) return std::numbers::pi * side_mm;
  const bool whole = projection == Projection::kDecal;
  return (aspect > 1) == whole ? side_mm : side_mm * aspect;
}

}  // namespace

Eigen::Vector2d Placement::uv(const Eigen::Vector2d& at_mm) const {
  const Eigen::Rotation2Dd back(projection == Projection::kCylindrical ? 0 : -turn_rad);
  Eigen::Vector2d at = back * at_mm;
  if (mirror) at.x() = -at.x();
  return {0.5 + at.x() / width_mm, 0.5 + at.y() / height_mm};
}

PlaneMap Placement::plane(int axis) const {
  const int right = axis == 0 ? 2 : 0;
  const int up = axis == 1 ? 2 : 1;
  const Eigen::Vector2d middle = uv(Eigen::Vector2d::Zero());
  PlaneMap map;
  map.per_mm = (uv(Eigen::Vector2d::UnitX()) - middle) * axes.col(right).transpose() +
               (uv(Eigen::Vector2d::UnitY()) - middle) * axes.col(up).transpose();
  map.at_origin = middle - map.per_mm * position_mm;
  return map;
}

double Placement::angle_rad(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d q = p - position_mm;
  return std::remainder(std::atan2(q.dot(axes.col(0)), -q.dot(axes.col(2))) - turn_rad,
                        kFullTurn_rad);
}

Eigen::Vector2d Placement::around(double angle_rad, const Eigen::Vector3d& p) const {
  return uv({angle_rad * radius_mm, (p - position_mm).dot(axes.col(1))});
}

Result<Placement> place(const Layer& layer, Projection projection, const mesh::Model& model,
                        const Eigen::Matrix3d& R_FO, double aspect) {
  Placement out;
  out.projection = projection;
  HP_ASSIGN_OR_RETURN(out.axes, axes_of(layer, projection, R_FO));
  const Box box = box_of(model, out.axes);
  out.position_mm = layer.position_mm.value_or(out.axes * (0.5 * (box.low + box.high)));
  const double side_mm = std::max(side_of(projection, box.size()), 1e-6);
  out.radius_mm = 0.5 * side_mm;
  out.width_mm = layer.size_mm.value_or(default_width(projection, side_mm, aspect));
  out.repeat = layer.repeat.value_or(stands_upright(projection));
  if (projection == Projection::kCylindrical && out.repeat) {
    const double around_mm = kFullTurn_rad * out.radius_mm;
    out.width_mm = around_mm / std::max(1.0, std::round(around_mm / out.width_mm));
  }
  out.height_mm = out.width_mm / aspect;
  out.depth_mm = layer.depth_mm.value_or(0);
  out.blend_mm = layer.blend_mm.value_or(kBlendPerSide * side_mm);
  out.turn_rad = layer.turn_rad;
  out.mirror = layer.mirror;
  return out;
}

}  // namespace hydroprint::image
