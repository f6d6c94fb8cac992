#include "sim/image/layers/layer_brush.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hydroprint::image {
namespace {

/// Error of the place on the picture, in its pixels, up to which the map of a cylinder counts as
/// linear.
constexpr double kLinear_px = 0.1;

/// Places on a patch where its map is compared with a linear one, barycentric.
const std::array<Eigen::Vector3d, 4> kBetween = {
    Eigen::Vector3d(0.75, 0.25, 0), Eigen::Vector3d(0, 0.75, 0.25), Eigen::Vector3d(0.25, 0, 0.75),
    Eigen::Vector3d::Constant(1.0 / 3)};

float clamp01(double t) { return static_cast<float>(t > 0 ? std::min(t, 1.0) : 0); }

float smooth_step(float x) { return x * x * (3 - 2 * x); }

const Chart& whole_texture() {
  static const Chart chart;
  return chart;
}

Linear linear(const BarycentricMap& map, const Eigen::Vector3d& at_corners) {
  Linear out;
  out.at_origin = at_corners.dot(map.at(0, 0));
  out.per_sample = {at_corners.dot(map.per_x()), at_corners.dot(map.per_y())};
  return out;
}

/// Change of a number from one sample to the next, at most.
double step_of(const Linear& number) { return number.per_sample.cwiseAbs().sum(); }

Corners uv_of(const PlaneMap& plane, const Patch& patch) {
  return {plane.uv(patch.position_mm[0]), plane.uv(patch.position_mm[1]),
          plane.uv(patch.position_mm[2])};
}

}  // namespace

Veiled PictureBrush::at(double x, double y) const {
  Veiled out{picture.at(x, y)};
  if (veil) out.veil = veil->at(x, y);
  return out;
}

Eigen::Vector3d RoundBrush::position(double x, double y) const {
  const Eigen::Vector3d at = map.at(x, y);
  return at[0] * position_mm[0] + at[1] * position_mm[1] + at[2] * position_mm[2];
}

Veiled RoundBrush::at(double x, double y) const {
  const Placement& placement = layer->placement;
  const Eigen::Vector3d p = position(x, y);
  const double angle_rad = placement.angle_rad(p);
  const auto place_of = [&](const Eigen::Vector3d& there) {
    const double turn_rad =
        std::remainder(placement.angle_rad(there) - angle_rad, 2 * std::numbers::pi);
    return placement.around(angle_rad + turn_rad, there);
  };
  const Eigen::Vector2d uv = place_of(p);
  const Corners at = {Eigen::Vector2d(x, y), Eigen::Vector2d(x + 1, y), Eigen::Vector2d(x, y + 1)};
  const Corners uvs = {uv, place_of(position(x + 1, y)), place_of(position(x, y + 1))};
  Veiled out{Brush(*layer->picture, whole_texture(), at, uvs).at(x, y)};
  if (layer->veil) out.veil = Brush(*layer->veil, whole_texture(), at, uvs).at(x, y);
  return out;
}

LayerBrush::LayerBrush(const LoadedLayer& layer, const Patch& patch) : layer_(&layer) {
  if (layer.own) {
    lay_own(patch);
    return;
  }
  if (layer.projection == Projection::kDecal) limit(patch);
  if (!shows_ || !layer.picture) return;
  if (layer.projection == Projection::kCylindrical) {
    lay_around(patch);
  } else if (layer.projection == Projection::kBox) {
    lay_box(patch);
  } else {
    add_picture(patch, uv_of(layer.planes[2], patch));
  }
}

void LayerBrush::lay_own(const Patch& patch) {
  PictureBrush brush{layer_->own->brush(patch.model_triangle, patch.at, patch.barycentric), {}};
  if (layer_->own_veil)
    brush.veil = layer_->own_veil->brush(patch.model_triangle, patch.at, patch.barycentric);
  pictures_.push_back(brush);
}

void LayerBrush::add_picture(const Patch& patch, const Corners& uv) {
  PictureBrush brush{Brush(*layer_->picture, whole_texture(), patch.at, uv), {}};
  if (layer_->veil) brush.veil = Brush(*layer_->veil, whole_texture(), patch.at, uv);
  pictures_.push_back(brush);
}

void LayerBrush::lay_around(const Patch& patch) {
  const Placement& placement = layer_->placement;
  const double first_rad = placement.angle_rad(patch.position_mm[0]);
  const auto around = [&](const Eigen::Vector3d& p) {
    const double turn_rad =
        std::remainder(placement.angle_rad(p) - first_rad, 2 * std::numbers::pi);
    return first_rad + turn_rad;
  };
  Corners uv;
  double error_px = 0, furthest_rad = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& p = patch.position_mm[i];
    uv[i] = placement.around(around(p), p);
    furthest_rad = std::max(furthest_rad, std::abs(around(p)));
  }
  // Not at the middles of edges, where the error vanishes if both ends are equally far from the
  // axis.
  for (const Eigen::Vector3d& at : kBetween) {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    Eigen::Vector2d linear_uv = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      p += at[static_cast<int>(i)] * patch.position_mm[i];
      linear_uv += at[static_cast<int>(i)] * uv[i];
    }
    const double error = placement.around(around(p), p).x() - linear_uv.x();
    error_px = std::max(error_px, std::abs(error) * layer_->picture->width());
  }
  const bool crosses_end = !placement.repeat && furthest_rad > std::numbers::pi;
  if (error_px <= kLinear_px && !crosses_end) {
    add_picture(patch, uv);
  } else {
    round_ = RoundBrush{layer_, BarycentricMap(patch.at), patch.position_mm};
  }
}

void LayerBrush::lay_box(const Patch& patch) {
  const BarycentricMap map(patch.at);
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d nearness;
    for (std::size_t i = 0; i < 3; ++i) {
      nearness[static_cast<int>(i)] =
          1 - static_cast<double>(patch.distances_mm[i][axis]) / layer_->placement.blend_mm;
    }
    if (!(nearness.maxCoeff() > 0)) continue;
    nearness_.push_back(linear(map, nearness));
    add_picture(patch, uv_of(layer_->planes[static_cast<std::size_t>(axis)], patch));
  }
}

void LayerBrush::limit(const Patch& patch) {
  const Placement& placement = layer_->placement;
  const Eigen::Vector3d direction = placement.axes.col(2);
  shows_ = patch.normal.dot(direction) < 0;
  const BarycentricMap map(patch.at);
  const Corners uv = uv_of(layer_->planes[2], patch);
  Eigen::Vector3d u, v, depth;
  for (std::size_t i = 0; i < 3; ++i) {
    const int k = static_cast<int>(i);
    u[k] = uv[i].x() - 0.5;
    v[k] = uv[i].y() - 0.5;
    depth[k] = direction.dot(patch.position_mm[i] - placement.position_mm);
  }
  within_ = {linear(map, u), linear(map, v)};
  if (placement.depth_mm > 0) within_.push_back(linear(map, depth / placement.depth_mm));
  for (const Linear& place : within_) {
    // Colours are also looked up a little beyond the patch.
    const double reach = 0.5 + step_of(place);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Eigen::Vector2d& at : patch.at) {
      low = std::min(low, place.at(at.x(), at.y()));
      high = std::max(high, place.at(at.x(), at.y()));
    }
    if (low > reach || high < -reach) shows_ = false;
  }
}

Veiled LayerBrush::colour_at(double x, double y) const {
  if (round_) return round_->at(x, y);
  if (!nearness_.empty()) return mean_of_axes(x, y);
  if (!pictures_.empty()) return pictures_.front().at(x, y);
  return {layer_->colour};
}

Veiled LayerBrush::mean_of_axes(double x, double y) const {
  Veiled sum{Eigen::Vector3f::Zero()};
  float weights = 0;
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    const float weight = smooth_step(clamp01(nearness_[i].at(x, y)));
    if (weight <= 0) continue;
    const Veiled one = pictures_[i].at(x, y);
    sum.over_white += weight * one.over_white;
    sum.veil += weight * one.veil;
    weights += weight;
  }
  if (!(weights > 0)) return pictures_.front().at(x, y);
  return {sum.over_white / weights, sum.veil / weights};
}

float LayerBrush::coverage_at(double x, double y) const {
  float covered = 1;
  for (const Linear& place : within_) {
    const double inside = 0.5 - std::abs(place.at(x, y)), step = step_of(place);
    covered *= step > 0 ? clamp01(inside / step + 0.5) : inside >= 0 ? 1.0F : 0.0F;
  }
  return covered;
}

Eigen::Vector3f LayerBrush::over(const Eigen::Vector3f& below, double x, double y) const {
  const float share = layer_->opacity * coverage_at(x, y);
  if (share <= 0) return below;
  const Veiled mine = colour_at(x, y);
  const Eigen::Vector3f colour = mine.over_white - mine.veil + mine.veil.cwiseProduct(below);
  return below + share * (colour - below);
}

Eigen::Vector3f SurfaceBrush::at(double x, double y) const {
  if (!has_layers_) return own_.at(x, y);
  Eigen::Vector3f colour = base_colour_;
  for (const LayerBrush& layer : layers_) colour = layer.over(colour, x, y);
  return colour;
}

}  // namespace hydroprint::image
