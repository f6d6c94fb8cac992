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

/// A sheet of the object's views, coloured by stretch (section 6) from dark blue over green to
/// yellow, with a legend; hatched grey where no film arrives. The colours stay apart for the
/// colour-blind and in grey.
/// @param map  of the tiles in view
[[nodiscard]] Result<RgbImage> stretch_picture(const ObjectViews& views,
                                               const flow::SurfaceMap& map, const Context& context);

/// Something to colour an object by.
struct Quantity {
  std::string label;           ///< beside the legend
  std::vector<double> values;  ///< of which all but the extremes fit the scale; NaN: left out
  double rest = 0, least_span = 0.1;  ///< the scale holds the one and is no shorter than the other
  /// At a tile's corners; NaN shows as where no film arrives.
  std::function<std::array<double, 3>(const flow::MappedTriangle&)> at_corners;
  std::string hatched = "no film";  ///< what NaN and bare surface are called
};

/// The same, coloured by any quantity.
[[nodiscard]] Result<RgbImage> quantity_picture(const ObjectViews& views, const Quantity& quantity,
                                                const Context& context);

/// The same, coloured by the smaller singular value.
[[nodiscard]] Result<RgbImage> wrinkle_picture(const ObjectViews& views,
                                               const flow::SurfaceMap& map, const Context& context);

/// The object as it will look: the film's colours where it lands, plain light grey elsewhere.
[[nodiscard]] Result<RgbImage> predicted_picture(const ObjectViews& views, const FilmTexture& film,
                                                 const Context& context);

/// Longest side, in pixels, that a film image needs for these pictures (FilmTexture::from_image).
inline constexpr int kPictureFilmSide_px = 3000;

}  // namespace hydroprint::image
