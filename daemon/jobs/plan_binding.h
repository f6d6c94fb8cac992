#pragma once

#include "daemon/jobs/kind.h"
#include "hydroprint/v1/spec.pb.h"

namespace hydroprint::daemon {

/// Fills a spec that names one dip of a plan: object, picture, scale and film from the plan; pose,
/// profile, resolution, model, depth and speed unless the spec sets them. Errors:
/// those of earlier_job(); SPEC_INVALID, naming the field, for another mesh and for a dip that the
/// plan does not have; STATE_FORBIDS for a plan without its files.
[[nodiscard]] Status take_plan(v1::SimulateSpec& spec, const JobSources& sources);

/// Adds the plan's files to a spec and removes the plan's name.
[[nodiscard]] Status adopt_plan(v1::SimulateSpec& spec, const JobSources& sources);

}  // namespace hydroprint::daemon
