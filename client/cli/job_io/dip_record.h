#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "client/cli/job_io/wait.h"
#include "hydroprint/v1/report.pb.h"

namespace hydroprint::cli {

/// Downloads the record of a dip (positions.csv, report.json) into `folder`; returns an empty list
/// if there is no record.
[[nodiscard]] Result<std::vector<Downloaded>> fetch_record(client::Connection& daemon,
                                                           const std::string& job,
                                                           const std::filesystem::path& folder);

/// Summarizes a dip in one line: depth, speed, largest deviation from constant speed. Omits what
/// the report lacks.
[[nodiscard]] std::string dip_summary(const std::string& job, const v1::DipReport& report);

}  // namespace hydroprint::cli
