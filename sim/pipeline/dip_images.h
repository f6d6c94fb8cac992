#pragma once

#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/film/film_image.h"
#include "sim/image/io/rgb_image.h"
#include "sim/image/layers/surface_paint.h"
#include "sim/pipeline/ink_passes.h"
#include "sim/plan/blend.h"

namespace hydroprint::pipeline {

/// The film images of one of several dips.
struct DipImages {
  image::RgbImage complete;  ///< the film image if this dip printed everything that it reaches
  image::RgbImage mask;      ///< grey: the dip's weight; 0 where no film lands
  image::RgbImage film;      ///< the image to print: complete, seen through the mask
};

/// What one of several dips prints: a picture, and how much of it.
struct DipShare {
  const image::SurfacePaint& paint;
  const plan::BlendWeights& weights;
  int dip = 1;  ///< from 1
};

/// Draws the film images of a dip. Returns the errors of image::film_image().
[[nodiscard]] Result<DipImages> draw_share(const DipShare& share, const mesh::Surface& surface,
                                           const std::vector<flow::MappedTriangle>& tiles,
                                           const film::Outline& outline, double dpi,
                                           const Context& context);

/// Draws only the film of draw_share(). What `share` refers to must outlive the drawing.
[[nodiscard]] FilmDrawing drawing_of(const DipShare& share, const film::Outline& outline);

}  // namespace hydroprint::pipeline
