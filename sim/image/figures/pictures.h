#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/surface_map.h"
#include "sim/image/figures/object_views.h"
#include "sim/image/film/film_texture.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// Draws a sheet of the object's views, coloured by stretch (section 6) from dark blue through
/// green to yellow, with a legend; hatched grey where no film arrives. The colours can be
/// distinguished by colour-blind readers and in greyscale.
/// @param map  the map that contains the tiles in `views`
[[nodiscard]] Result<RgbImage> stretch_picture(const ObjectViews& views,
                                               const flow::SurfaceMap& map, const Context& context);

/// A quantity by which to colour an object.
struct Quantity {
  std::string label;           ///< title of the legend
  std::vector<double> values;  ///< the scale ignores extremes and NaN
  /// The scale contains `rest` (the value without any effect) and extends at least `least_span`
  /// above it.
  double rest = 0, least_span = 0.1;
  /// Returns the values at a tile's corners; NaN is drawn as if no film arrived.
  std::function<std::array<double, 3>(const flow::MappedTriangle&)> at_corners;
  std::string hatched = "no film";  ///< legend label of NaN and of the bare surface
};

/// Same as stretch_picture(), coloured by the given quantity.
[[nodiscard]] Result<RgbImage> quantity_picture(const ObjectViews& views, const Quantity& quantity,
                                                const Context& context);

/// Same as stretch_picture(), coloured by the smaller singular value of the film-to-surface
/// Jacobian.
[[nodiscard]] Result<RgbImage> wrinkle_picture(const ObjectViews& views,
                                               const flow::SurfaceMap& map, const Context& context);

/// Same as stretch_picture(), coloured by the stated error of the film points on the film, up to
/// 0.5 mm; hatched where no bound is known.
[[nodiscard]] Result<RgbImage> error_picture(const ObjectViews& views, const flow::SurfaceMap& map,
                                             const Context& context);

/// Draws the object with its predicted look: the film's colours where it lands, light grey
/// elsewhere.
[[nodiscard]] Result<RgbImage> predicted_picture(const ObjectViews& views, const FilmTexture& film,
                                                 const Context& context);

/// Film images are reduced to at most this number of pixels per side for these pictures
/// (FilmTexture::from_image).
inline constexpr int kPictureFilmSide_px = 3000;

}  // namespace hydroprint::image
