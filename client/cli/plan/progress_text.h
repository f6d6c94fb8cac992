#pragma once

#include <string>

#include "hydroprint/v1/job_service.pb.h"

namespace hydroprint::cli {

/// Returns the dips of a plan as a table, a line for each, with what went wrong and warnings below.
[[nodiscard]] std::string table_of(const v1::PlanProgress& progress);

/// Returns the next step of a plan and the command that does it, or that all dips are done.
[[nodiscard]] std::string next_text(const v1::PlanProgress& progress);

/// Returns the step of a dip in one line, with the dip's trouble and warnings below.
/// @param count  number of dips of the plan
[[nodiscard]] std::string step_text(const v1::PlanProgress::Dip& dip, int count);

}  // namespace hydroprint::cli
