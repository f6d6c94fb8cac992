#pragma once

#include <string>
#include <vector>

#include "hydroprint/v1/job.pb.h"

namespace hydroprint::client {

/// Returns whether the operator has to confirm this step of a dip.
[[nodiscard]] bool waits_for_operator(v1::DipStatus::Step step);

/// Returns the names of the steps that wait for the operator, in order.
[[nodiscard]] std::vector<std::string> operator_steps();

}  // namespace hydroprint::client
