#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Converts a film image to printable files: print.pdf, and print.png and print.tif (print-N.png
/// and print-N.tif for several sheets).
[[nodiscard]] Verb print_image_verb();

}  // namespace hydroprint::worker
