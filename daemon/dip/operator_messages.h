#pragma once

#include <string>

#include "daemon/dip/plan.h"

namespace hydroprint::dip {

/// Instruction for the operator in this step, or a description of the motion.
[[nodiscard]] std::string instruction(Step step, const Plan& plan);

/// Instruction for the object after a successful dip.
[[nodiscard]] std::string afterwards();

/// Instruction for film and object when a dip ends early in this step.
[[nodiscard]] std::string advice(Step step);

/// Warning that the film was activated too long ago.
[[nodiscard]] std::string late_words(double since_sprayed_s, const Clocks& clocks);

}  // namespace hydroprint::dip
