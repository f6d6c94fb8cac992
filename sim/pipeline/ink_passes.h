#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/texture/paint.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/stokes_pass.h"

namespace hydroprint::pipeline {

/// Computes the dip of a film that carries the ink of its own film image: the two-step scheme of
/// section 4.3, repeated. Each pass draws the film image for the flow so far, computes the
/// thickness of its ink and solves the sheet with it. The passes start from Stokes flow. They end
/// after `most_passes`, or when a pass moves the film by less than a pixel. The figures list the
/// result of each pass.
/// @param first        the first pass of this model with these options
/// @param most_passes  at least 1
/// @param dpi          resolution of the film image
[[nodiscard]] Result<Dip> dip_inked(const mesh::Model& model, StokesPass first,
                                    const image::Paint& paint, int most_passes, double dpi,
                                    const DipOptions& options, const Context& context);

}  // namespace hydroprint::pipeline
