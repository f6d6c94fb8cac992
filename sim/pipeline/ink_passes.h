#pragma once

#include "sim/base/context.h"
#include "sim/base/result.h"
#include "sim/image/paint.h"
#include "sim/pipeline/start.h"

namespace hydroprint::pipeline {

/// The sheet that carries the ink of its own film image, and where it lands.
struct InkedFlow {
  flow::DipField field;
  flow::FlowMap map;
  std::vector<InkPass> passes;
};

/// The two-step scheme of section 4.3, repeated: a film image for the film as it is thought to
/// move, the thickness of its ink, the sheet that carries it. It begins with Stokes flow and ends
/// after `most_passes`, or when a pass moves the film by less than a pixel.
[[nodiscard]] Result<InkedFlow> ink_passes(const Start& start, const image::Paint& paint,
                                           int most_passes, double dpi, const DipOptions& options,
                                           const Context& context);

}  // namespace hydroprint::pipeline
