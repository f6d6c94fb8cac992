#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/layers/layer.h"
#include "sim/image/layers/placement.h"
#include "sim/image/texture/paint.h"
#include "sim/image/texture/texture.h"
#include "sim/mesh/model.h"

namespace hydroprint::image {

/// A layer with its place on the object.
struct PlacedLayer {
  std::string name;
  Projection projection = Projection::kUv;
  Placement placement;  ///< not for kUv and kVertexColours
  float opacity = 1;
};

/// A layer whose picture has been read. Its colour is c = a p + (1 - a) b for the picture's colour
/// p and opacity a over what is below, b. Textures store what a picture shows over white,
/// a p + (1 - a), and its veil 1 - a, because both can be averaged.
struct LoadedLayer : PlacedLayer {
  std::array<PlaneMap, 3> planes;                    ///< of the placement, per axis
  Eigen::Vector3f colour = Eigen::Vector3f::Ones();  ///< linear; without a picture
  std::shared_ptr<const Texture> picture, veil;      ///< null: none, opaque
  std::shared_ptr<const Paint> own, own_veil;        ///< of kUv and kVertexColours

  /// True if it hides everything below it, everywhere.
  [[nodiscard]] bool is_opaque() const;
};

/// The desired look of an object as layers: a colour for every point of its surface.
struct LayeredPaint {
  Eigen::Vector3f base_colour = Eigen::Vector3f::Ones();  ///< linear
  std::vector<LoadedLayer> layers;                        ///< the lowest first
  Warnings warnings;

  /// False if the film would stay white everywhere.
  [[nodiscard]] bool has_colour() const;
  [[nodiscard]] std::vector<PlacedLayer> placed() const { return {layers.begin(), layers.end()}; }
};

/// Reads the pictures of a paint and places its layers on a model. A layer without a projection
/// gets kUv if the model has texture coordinates, otherwise kDip, with the warning
/// picture_projected.
/// @param R_FO  rotation from frame O to frame F at the start of the dip
/// @return the errors of read_image(), load_paint() and place(). kInvalidArgument for texture
///     coordinates or colours that the model does not have, kOutOfRange for pictures that together
///     have more than kMaxImageArea_px
[[nodiscard]] Result<LayeredPaint> load_layers(const mesh::Model& model, const PaintSource& source,
                                               const Eigen::Matrix3d& R_FO, const Context& context);

}  // namespace hydroprint::image
