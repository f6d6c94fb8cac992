#pragma once

#include "client/cli/program/program.h"
#include "client/job.h"

namespace hydroprint::cli {

/// Says where a dip stands and what to do next, or prints it as JSON.
void print_dip(const Program& program, const client::Job& job);

}  // namespace hydroprint::cli
