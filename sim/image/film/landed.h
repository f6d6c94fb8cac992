#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/flow/surface_map.h"
#include "sim/image/film/film_texture.h"
#include "sim/mesh/model.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// Returns the colour that lands on each point of the surface, sRGB-coded in [0, 1]; NaN where no
/// film arrives.
[[nodiscard]] std::vector<Eigen::Vector3f> landed_colours(const flow::SurfaceMap& map,
                                                          const FilmTexture& film);

/// 8-bit sRGB and opacity (0 or 255), row 0 at the top.
struct RgbaImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Computes the colours of the landed film as a texture of the object. Each texel gets the colour
/// of the film that lands there, filtered over the texel; white and transparent where no film
/// lands. The earliest contact wins where parts of the surface share texels. Coordinates outside
/// [0, 1] repeat. Errors: kFailedPrecondition for a model without UVs, kOutOfRange for sizes
/// outside 1 to 16384.
[[nodiscard]] Result<RgbaImage> landed_texture(const mesh::Model& model,
                                               const mesh::Surface& surface,
                                               const std::vector<flow::MappedTriangle>& tiles,
                                               const FilmTexture& film, int width, int height,
                                               const Context& context);

}  // namespace hydroprint::image
