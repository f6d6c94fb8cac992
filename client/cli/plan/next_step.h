#pragma once

#include <string>

#include "client/cli/program/program.h"
#include "hydroprint/v1/job_service.pb.h"
#include "sim/base/result.h"

namespace hydroprint::cli {

/// Options of the next step of a plan.
struct StepOptions {
  int immersion = 0;      ///< number of the dip; 0: the one that is next
  std::string out;        ///< folder for pages, picture and record; empty: "dip-N"
  bool yes = false;       ///< the object hangs as planned: calibrate without asking
  bool no_guide = false;  ///< only create the dip, and keep the lease
  v1::DipSpec dip;        ///< options of the dip; its simulate job is set by the step
};

/// Says and does the next step of one dip of a plan; prints the progress as JSON if it is done.
/// @return kInvalidArgument for a dip that the plan does not have, and if a step needs a terminal;
///         otherwise the error of the step's job
[[nodiscard]] Status do_next_step(Program& program, const v1::PlanProgress& progress,
                                  const StepOptions& options);

}  // namespace hydroprint::cli
