#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Puts a film image on paper: print.pdf; print.png and print.tif, or print-N.png and print-N.tif
/// for several sheets.
[[nodiscard]] Verb print_image_verb();

}  // namespace hydroprint::worker
