#pragma once

#include <functional>
#include <vector>

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/io/rgb_image.h"
#include "sim/image/layers/surface_paint.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/stokes_pass.h"

namespace hydroprint::pipeline {

/// Draws a film image for the flow so far.
using FilmDrawing = std::function<Result<image::RgbImage>(
    const mesh::Surface& surface, const std::vector<flow::MappedTriangle>& tiles, double dpi,
    const Context& context)>;

/// Draws the film image of this paint.
[[nodiscard]] FilmDrawing drawing_of(image::SurfacePaint paint, const film::Outline& outline);

/// Computes the dip of a film that carries the ink of its own film image: the two-step scheme of
/// section 4.3, repeated. Each pass draws the film image for the flow so far, computes the
/// thickness of its ink and solves the sheet with it. The passes start from Stokes flow. They end
/// after `most_passes`, or when a pass moves the film by less than a pixel. The figures list the
/// result of each pass.
/// @param first        the first pass of this model with these options
/// @param draw         draws the film's own image
/// @param most_passes  at least 1
/// @param dpi          resolution of the film image
[[nodiscard]] Result<Dip> dip_inked(const mesh::Model& model, StokesPass first,
                                    const FilmDrawing& draw, int most_passes, double dpi,
                                    const DipOptions& options, const Context& context);

}  // namespace hydroprint::pipeline
