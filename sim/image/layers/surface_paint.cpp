#include "sim/image/layers/surface_paint.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <utility>

#include "sim/base/check.h"

namespace hydroprint::image {
namespace {

/// Distances are stored up to this multiple of the width of the blend.
constexpr double kFurthest = 2;

const std::array<Eigen::Vector3d, 3> kWhole = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(),
                                               Eigen::Vector3d::UnitZ()};

/// A layer of the model's own colours that shows everywhere.
bool is_plain_own(const LayeredPaint& paint) {
  return paint.layers.size() == 1 && paint.layers[0].own && paint.layers[0].is_opaque();
}

std::array<Eigen::Vector3d, 3> corners_of(const mesh::Surface& surface, int triangle) {
  const Eigen::Vector3i& t = surface.triangles[static_cast<std::size_t>(triangle)];
  const auto& p = surface.points;
  return {p[static_cast<std::size_t>(t[0])], p[static_cast<std::size_t>(t[1])],
          p[static_cast<std::size_t>(t[2])]};
}

Eigen::Vector3d normal_of(const std::array<Eigen::Vector3d, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

/// Returns the index of the lowest layer that others do not hide.
std::size_t lowest_shown(const std::vector<LoadedLayer>& layers) {
  std::size_t out = layers.size();
  while (out > 0 && (out == layers.size() || !layers[out].is_opaque())) --out;
  return out;
}

/// Returns the distances at the corners of a tile.
std::array<Eigen::Vector3f, 3> distances_at(const AxisDistances& distances,
                                            const mesh::Surface& surface,
                                            const flow::MappedTriangle& tile) {
  const Eigen::Vector3i& t = surface.triangles[static_cast<std::size_t>(tile.triangle)];
  std::array<Eigen::Vector3f, 3> out;
  for (std::size_t i = 0; i < 3; ++i) {
    out[i].setZero();
    for (int k = 0; k < 3; ++k)
      out[i] += tile.barycentric[i][k] * distances[static_cast<std::size_t>(t[k])];
  }
  return out;
}

/// Returns whether a decal shows on some triangle of the surface.
bool covers(const LoadedLayer& layer, const mesh::Surface& surface) {
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    Patch patch;
    patch.position_mm = corners_of(surface, static_cast<int>(t));
    patch.normal = normal_of(patch.position_mm);
    // The grid of the film does not matter for the question, so any triangle will do.
    patch.at = {Eigen::Vector2d(0, 0), Eigen::Vector2d(100, 0), Eigen::Vector2d(0, 100)};
    patch.model_triangle = surface.source_triangle[t];
    patch.barycentric = kWhole;
    if (LayerBrush(layer, patch).shows()) return true;
  }
  return false;
}

void warn_of_nothing(const LoadedLayer& layer, const mesh::Surface& surface, Warnings& warnings) {
  std::string reason;
  if (layer.opacity <= 0) {
    reason = "its opacity is 0";
  } else if (layer.projection == Projection::kDecal && !covers(layer, surface)) {
    reason = "no part of the surface that faces it is within its size and depth";
  }
  if (reason.empty()) return;
  warnings.push_back(
      {WarningCode::LAYER_COVERS_NOTHING,
       fmt::format("layer {} covers nothing: {}. Move it, or leave it out", layer.name, reason),
       {InLayer{layer.name}}});
}

}  // namespace

Result<SurfacePaint> SurfacePaint::fit(const LayeredPaint& paint, const mesh::Surface& surface,
                                       const Context& context) {
  SurfacePaint out;
  if (is_plain_own(paint)) {
    out.own_ = paint.layers[0].own.get();
    return out;
  }
  out.layers_ = &paint;
  for (const LoadedLayer& layer : paint.layers) {
    warn_of_nothing(layer, surface, out.warnings_);
    AxisDistances& distances = out.distances_.emplace_back();
    if (layer.projection != Projection::kBox || !layer.picture) continue;
    HP_ASSIGN_OR_RETURN(distances, axis_distances(surface, layer.placement.axes,
                                                  kFurthest * layer.placement.blend_mm, context));
  }
  return out;
}

bool SurfacePaint::has_colour() const {
  return own_ != nullptr ? own_->has_colour() : layers_->has_colour();
}

SurfaceBrush SurfacePaint::brush(const mesh::Surface& surface, const flow::MappedTriangle& tile,
                                 const Corners& at) const {
  const auto triangle = static_cast<std::size_t>(tile.triangle);
  const auto barycentric = model_barycentric(surface, tile);
  if (own_ != nullptr)
    return SurfaceBrush(own_->brush(surface.source_triangle[triangle], at, barycentric));
  Patch patch{at, {}, {}, surface.source_triangle[triangle], barycentric, {}};
  const auto corners = corners_of(surface, tile.triangle);
  patch.normal = normal_of(corners);
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d b = tile.barycentric[i].cast<double>();
    patch.position_mm[i] = b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2];
  }
  SurfaceBrush out(layers_->base_colour);
  const auto& layers = layers_->layers;
  for (std::size_t i = lowest_shown(layers); i < layers.size(); ++i) {
    if (!distances_[i].empty()) patch.distances_mm = distances_at(distances_[i], surface, tile);
    LayerBrush layer(layers[i], patch);
    if (layer.shows()) out.add(std::move(layer));
  }
  return out;
}

std::array<Eigen::Vector3d, 3> model_barycentric(const mesh::Surface& surface,
                                                 const flow::MappedTriangle& tile) {
  std::array<Eigen::Vector3d, 3> out;
  const auto& source = surface.source_barycentric[tile.triangle];
  for (int i = 0; i < 3; ++i) {
    out[i].setZero();
    for (int k = 0; k < 3; ++k) {
      out[i] += static_cast<double>(tile.barycentric[i][k]) * source[k].cast<double>();
    }
  }
  return out;
}

}  // namespace hydroprint::image
