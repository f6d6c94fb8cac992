#pragma once

#include <string>

#include "daemon/dip/plan.h"

namespace hydroprint::dip {

/// Returns the instruction for the operator in this step, or a description of the motion.
[[nodiscard]] std::string instruction(Step step, const Plan& plan);

/// Returns the instruction for handling the object after a successful dip.
[[nodiscard]] std::string afterwards(const Plan& plan);

/// Returns the instruction for handling film and object when a dip ends early in this step.
[[nodiscard]] std::string advice(Step step);

/// Returns the warning that too much time has passed since the film was activated.
[[nodiscard]] std::string late_words(double since_sprayed_s, const Clocks& clocks);

}  // namespace hydroprint::dip
