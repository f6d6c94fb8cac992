#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/figures/object_views.h"
#include "sim/image/film/film_texture.h"
#include "sim/image/io/rgb_image.h"

namespace hydroprint::image {

/// Ink that films leave on an object, at the samples of each of its views: CMY (white minus coded
/// RGB, section 6), from 0; NaN where no film lands.
using LandedInk = std::vector<std::vector<Eigen::Vector3f>>;

/// Returns the ink of one film.
/// @param views  with the tiles of that film
[[nodiscard]] Result<LandedInk> landed_ink(const ObjectViews& views, const FilmTexture& film,
                                           const Context& context);

/// Adds the ink of another film on the same views. An empty `ink` stands for no film.
void add_ink(const LandedInk& more, LandedInk& ink);

/// Draws the object with its ink, at most full ink; light grey where no film lands.
/// @param views  those of the ink, without tiles
[[nodiscard]] Result<RgbImage> ink_picture(const ObjectViews& views, const LandedInk& ink,
                                           const Context& context);

}  // namespace hydroprint::image
