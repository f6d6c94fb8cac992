#pragma once

#include <string>
#include <vector>

#include "hydroprint/v1/job.pb.h"

namespace hydroprint::client {

/// Returns whether the operator has to confirm this step of a dip.
[[nodiscard]] bool waits_for_operator(v1::DipStatus::Step step);

/// Returns the instruction of a dip's step; for a dip of a plan, after "dip 2 of 3: ".
[[nodiscard]] std::string instruction_of(const v1::DipStatus& status);

/// Returns "dip 2 of 3: ".
[[nodiscard]] std::string which_dip(int number, int count);

/// Returns the names of the steps that wait for the operator, in order.
[[nodiscard]] std::vector<std::string> operator_steps();

}  // namespace hydroprint::client
