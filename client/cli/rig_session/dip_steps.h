#pragma once

#include "client/cli/program/program.h"
#include "hydroprint/v1/job.pb.h"

namespace hydroprint::cli {

/// Prints the current step of a dip and the next action, or JSON.
void print_dip(const Program& program, const v1::Job& job);

}  // namespace hydroprint::cli
