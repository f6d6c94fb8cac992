#pragma once

#include <vector>

#include "sim/base/pose.h"
#include "sim/base/result.h"
#include "sim/pipeline/plan.h"
#include "sim/worker/common/report.h"

namespace hydroprint::v1 {
class Plan;
class PlanReport;
}  // namespace hydroprint::v1

// The messages of the files that plan writes. For inclusion in .cpp files only.
namespace hydroprint::worker {

/// Sets the pose of each dip as it was used, for plan.json.
void set_poses(const pipeline::Plan& plan, v1::Plan& out);

/// Sets the findings of report.json: sizes of the mesh, the dips, stretch and seam.
void set_findings(const pipeline::Plan& plan, const std::vector<pipeline::DipPrint>& prints,
                  v1::PlanReport& out);

/// Sets what all reports have in common: inputs, times, memory, warnings, artifacts.
void set_run(const Report& report, v1::PlanReport& out);

}  // namespace hydroprint::worker
