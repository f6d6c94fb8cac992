#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/surface_map.h"
#include "sim/image/layers/axis_distance.h"
#include "sim/image/layers/layer_brush.h"
#include "sim/image/layers/layered_paint.h"
#include "sim/image/texture/paint.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// A paint on the surface that is computed with: the model's own, or layers.
class SurfacePaint {
 public:
  /// The colours of a model. The paint must outlive this object.
  SurfacePaint(const Paint& own) : own_(&own) {}  // NOLINT(google-explicit-constructor)

  /// Fits layers to a surface, and warns of those that cover no part of it (layer_covers_nothing).
  /// The paint must outlive the result.
  [[nodiscard]] static Result<SurfacePaint> fit(const LayeredPaint& paint,
                                                const mesh::Surface& surface,
                                                const Context& context);

  [[nodiscard]] bool has_colour() const;
  [[nodiscard]] const Warnings& warnings() const { return warnings_; }

  /// Returns the colours of a tile of the film.
  /// @param surface  that of fit(), or any surface of the model
  /// @param at       the tile's corners on the sample grid
  [[nodiscard]] SurfaceBrush brush(const mesh::Surface& surface, const flow::MappedTriangle& tile,
                                   const Corners& at) const;

 private:
  SurfacePaint() = default;

  const Paint* own_ = nullptr;
  const LayeredPaint* layers_ = nullptr;
  std::vector<AxisDistances> distances_;  ///< per layer; empty: not kBox
  Warnings warnings_;
};

/// Returns the corners of a tile as barycentric coordinates of its triangle of the model.
[[nodiscard]] std::array<Eigen::Vector3d, 3> model_barycentric(const mesh::Surface& surface,
                                                               const flow::MappedTriangle& tile);

}  // namespace hydroprint::image
