#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "sim/image/layers/layered_paint.h"
#include "sim/image/texture/paint.h"
#include "sim/image/texture/raster.h"

namespace hydroprint::image {

/// A small piece of the surface, on which positions are linear in the place on the sample grid.
struct Patch {
  Corners at;                                   ///< its corners on the sample grid
  std::array<Eigen::Vector3d, 3> position_mm;   ///< frame O
  Eigen::Vector3d normal;                       ///< outward, any length
  int model_triangle = 0;                       ///< index into Model::triangles
  std::array<Eigen::Vector3d, 3> barycentric;   ///< of the corners in that triangle
  std::array<Eigen::Vector3f, 3> distances_mm;  ///< to the axes (AxisDistances); only for kBox
};

/// A number that is linear in the place on the sample grid.
struct Linear {
  double at_origin = 0;
  Eigen::Vector2d per_sample = Eigen::Vector2d::Zero();

  [[nodiscard]] double at(double x, double y) const {
    return at_origin + per_sample.x() * x + per_sample.y() * y;
  }
};

/// What a layer's picture shows over white, and its veil; see LoadedLayer.
struct Veiled {
  Eigen::Vector3f over_white = Eigen::Vector3f::Ones();
  Eigen::Vector3f veil = Eigen::Vector3f::Zero();
};

/// A picture on a patch, through an affine map.
struct PictureBrush {
  Brush picture;
  std::optional<Brush> veil;

  [[nodiscard]] Veiled at(double x, double y) const;
};

/// A picture around a cylinder on a patch near its axis, where the map is far from linear.
struct RoundBrush {
  const LoadedLayer* layer = nullptr;
  BarycentricMap map;
  std::array<Eigen::Vector3d, 3> position_mm;

  [[nodiscard]] Veiled at(double x, double y) const;

 private:
  [[nodiscard]] Eigen::Vector3d position(double x, double y) const;
};

/// One layer on a patch.
class LayerBrush {
 public:
  LayerBrush(const LoadedLayer& layer, const Patch& patch);

  /// False if the layer shows nothing on the patch.
  [[nodiscard]] bool shows() const { return shows_; }
  /// Returns the colour over what is below; linear light.
  [[nodiscard]] Eigen::Vector3f over(const Eigen::Vector3f& below, double x, double y) const;

 private:
  void lay_own(const Patch& patch);
  void lay_plane(const Patch& patch);
  void lay_around(const Patch& patch);
  void lay_box(const Patch& patch);
  void limit(const Patch& patch);
  void add_picture(const Patch& patch, const Corners& uv);
  [[nodiscard]] Veiled colour_at(double x, double y) const;
  [[nodiscard]] Veiled mean_of_axes(double x, double y) const;
  [[nodiscard]] float coverage_at(double x, double y) const;

  const LoadedLayer* layer_;
  bool shows_ = true;
  std::vector<PictureBrush> pictures_;  ///< one, or one per axis of kBox
  std::vector<Linear> nearness_;        ///< of kBox, per picture: 1 - D / blend_mm
  std::optional<RoundBrush> round_;     ///< instead of pictures_
  std::vector<Linear> within_;          ///< of kDecal: places from -1/2 to 1/2 are inside
};

/// The colours of a piece of a film.
class SurfaceBrush {
 public:
  /// The colours of a model.
  explicit SurfaceBrush(const Brush& own) : own_(own) {}
  /// A base colour (linear), above which layers are added.
  explicit SurfaceBrush(const Eigen::Vector3f& base_colour)
      : base_colour_(base_colour), has_layers_(true) {}

  /// Adds a layer above those before.
  void add(LayerBrush layer) { layers_.push_back(std::move(layer)); }

  /// Returns the mean colour in linear light over the sample at this grid point.
  [[nodiscard]] Eigen::Vector3f at(double x, double y) const;

 private:
  Brush own_;
  Eigen::Vector3f base_colour_ = Eigen::Vector3f::Ones();
  bool has_layers_ = false;
  std::vector<LayerBrush> layers_;
};

}  // namespace hydroprint::image
