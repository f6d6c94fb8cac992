#pragma once

#include "client/cli/program/program.h"
#include "client/job.h"

namespace hydroprint::cli {

/// Prints the current step of a dip and the next action, or JSON.
void print_dip(const Program& program, const client::Job& job);

}  // namespace hydroprint::cli
