#pragma once

#include "sim/base/context.h"
#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/flow/surface_map.h"
#include "sim/image/film_texture.h"
#include "sim/image/picture.h"
#include "sim/mesh/surface.h"

namespace hydroprint::image {

/// A sheet of four views of the object as it goes into the water (+z of F up), coloured by stretch
/// (section 6) from dark blue over green to yellow, with a legend; hatched grey where no film
/// arrives. About 1600 pixels wide. The colours stay apart for the colour-blind and in grey.
[[nodiscard]] Result<RgbImage> stretch_picture(const mesh::Surface& surface, const Pose& X_FO,
                                               const flow::FlowMap& map, const Context& context);

/// The same views of the object as it will look: the film's colours where it lands, plain light
/// grey elsewhere.
[[nodiscard]] Result<RgbImage> predicted_picture(const mesh::Surface& surface, const Pose& X_FO,
                                                 const std::vector<flow::MappedTriangle>& tiles,
                                                 const FilmTexture& film, const Context& context);

/// Longest side, in pixels, that a film image needs for these pictures (FilmTexture::from_image).
inline constexpr int kPictureFilmSide_px = 3000;

}  // namespace hydroprint::image
