#pragma once

#include <string>

#include "daemon/dip/plan.h"

namespace hydroprint::dip {

/// What the operator is to do in this step, or what is happening.
[[nodiscard]] std::string instruction(Step step, const Plan& plan);

/// What to do with the object after a dip that went through.
[[nodiscard]] std::string afterwards();

/// What to do with film and object when a dip ends in this step, before it was through.
[[nodiscard]] std::string advice(Step step);

/// That the film was activated so long ago.
[[nodiscard]] std::string late_words(double since_sprayed_s, const Clocks& clocks);

}  // namespace hydroprint::dip
