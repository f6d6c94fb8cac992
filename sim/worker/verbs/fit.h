#pragma once

#include "sim/worker/common/verb.h"

namespace hydroprint::worker {

/// Fits a film profile to measured points. Writes film_profile.toml, residuals.csv and
/// residuals.png.
[[nodiscard]] Verb fit_verb();

}  // namespace hydroprint::worker
