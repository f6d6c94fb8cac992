#pragma once

#include "hydroprint/v1/report.pb.h"

namespace hydroprint::cli {

/// Returns the common part of a report.
[[nodiscard]] const v1::RunFacts& run_of(const v1::JobReport& report);

/// Prints the warnings and the main figures of a report.
void print_report(const v1::JobReport& report);

}  // namespace hydroprint::cli
