#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/paint.h"
#include "sim/pipeline/pipeline.h"
#include "sim/pipeline/start.h"

namespace hydroprint::pipeline {

/// The dip of a film that is printed with what it is to carry to the object, by the two-step scheme
/// of section 4.3, repeated: a film image for the film as it is thought to move, the thickness of
/// its ink, the sheet that carries it. It begins with Stokes flow and ends after `most_passes`, or
/// when a pass moves the film by less than a pixel; what each pass did is among the figures.
/// @param begun        the dip of this model, with these options
/// @param most_passes  at least 1
/// @param dpi          of the film image
[[nodiscard]] Result<Dip> dip_inked(const mesh::Model& model, Start begun,
                                    const image::Paint& paint, int most_passes, double dpi,
                                    const DipOptions& options, const Context& context);

}  // namespace hydroprint::pipeline
