#pragma once

#include <filesystem>
#include <string>

#include "sim/base/result.h"
#include "sim/pipeline/plan_share.h"
#include "sim/worker/common/flags.h"
#include "sim/worker/common/input_folder.h"

namespace hydroprint::v1 {
class SimulateSpec;
}

// One dip of a plan of several dips: the folder of `hydroprint-worker plan`. For inclusion in .cpp
// files only.
namespace hydroprint::worker {

/// Adds `--plan DIR`.
void add_plan_flag(Flags& flags);

/// The dip of a plan that a spec names.
struct PlannedDipOptions {
  std::filesystem::path plan_json, plan_ply;  ///< empty: no plan
  std::string mesh_sha256;                    ///< hex
  pipeline::PlanShare share;                  ///< without its surface and stretch
};

/// Takes what a spec leaves out from its plan: pose and depth of the dip, scale, film, resolution,
/// model, ink passes, inertia and speed. Reads only plan.json. Does nothing without a plan.
/// Returns fail_field() for an incomplete list of files, a dip that the plan does not have, another
/// scale or film than the plan's, and a missing film profile; for a plan.json that cannot be
/// used, an error that names it.
[[nodiscard]] Result<PlannedDipOptions> take_plan(const InputFolder& inputs,
                                                  v1::SimulateSpec& spec);

/// Reads plan.ply. Returns kInvalidArgument, naming the file, if it is not one of this plan.
[[nodiscard]] Result<pipeline::PlanShare> read_share(const PlannedDipOptions& options);

}  // namespace hydroprint::worker
